#include "pyroclast/mechanics/sweep.hpp"

#include <algorithm>

namespace pyroclast {

namespace {

// Times of a piece, with its faces, and of a part whose corner forces are there, over that of as many zones
// of an alike bundle (20,000 blocks on one thread: 6.7, 2.4 and 6.1 ns a zone).
constexpr double kPieceCost = 1.1, kPartCost = 0.4;

double cost(const Bundle& bundle) {
  const double of_zones = bundle.kind != BundleKind::piece ? 1.0 : bundle.is_part ? kPartCost : kPieceCost;
  return of_zones * bundle.zone_packs();
}

/// Bundles that a pack of faces touches.
struct BundlesOfFaces {
  int first, last;
  bool leads = false;  ///< true where one of them leads
};

template <int Dim>
std::vector<BundlesOfFaces> bundles_of_faces(const Layout<Dim>& layout, const std::vector<bool>& leads) {
  std::vector<BundlesOfFaces> touched;
  for (int r = 0; r < layout.face_packs(); ++r) {
    const int first_point = layout.first_point_of(r), last_point = layout.first_point_of(r + 1);
    BundlesOfFaces of_pack{static_cast<int>(layout.bundles.size()), 0};
    for (int point = first_point; point < last_point; ++point)
      for (int lane = 0; lane < kLanes; ++lane)
        for (int offset : {layout.points[point].a[lane], layout.points[point].b[lane]}) {
          const int bundle = layout.bundle_of_pack[offset / offset_of<Dim>(kLanes)];
          of_pack.first = std::min(of_pack.first, bundle);
          of_pack.last = std::max(of_pack.last, bundle);
          of_pack.leads = of_pack.leads || leads[bundle];
        }
    touched.push_back(of_pack);
  }
  return touched;
}

void append(std::vector<IndexRange>& ranges, int i) {
  if (!ranges.empty() && ranges.back().last == i)
    ++ranges.back().last;
  else
    ranges.push_back({i, i + 1});
}

/// Returns the bundles of each thread: ranges of own ones that cost about the same.
template <int Dim>
std::vector<IndexRange> bundle_ranges(const Layout<Dim>& layout, int threads) {
  std::vector<IndexRange> ranges(threads);
  const auto [first, last] = layout.chunks.bundles.own();
  double total = 0.0, taken = 0.0;
  for (int i = first; i < last; ++i) total += cost(layout.bundles[i]);
  int b = first;
  for (int t = 0; t < threads; ++t) {
    ranges[t].first = b;
    while (b < last && (t + 1 == threads || taken < total * (t + 1) / threads))
      taken += cost(layout.bundles[b++]);
    ranges[t].last = b;
  }
  return ranges;
}

/// Returns the parts among some bundles.
template <int Dim>
IndexRange parts_among(const Layout<Dim>& layout, int first_bundle, int last_bundle) {
  const auto before = [&](int bundle) {
    return static_cast<int>(std::ranges::lower_bound(layout.parts, bundle) - layout.parts.begin());
  };
  return {before(first_bundle), before(last_bundle)};
}

/// Returns the first of the own parts whose corner forces a thread computes; all have about as many zones to
/// do.
template <int Dim>
int first_part(const Layout<Dim>& layout, int thread, int threads) {
  const auto [first_bundle, last_bundle] = layout.chunks.bundles.own();
  const IndexRange own = parts_among(layout, first_bundle, last_bundle);
  int zone_packs = 0, before = 0;
  for (int i = own.first; i < own.last; ++i) zone_packs += layout.bundles[layout.parts[i]].zone_packs();
  for (int i = own.first; i < own.last && thread < threads; ++i) {
    if (static_cast<std::int64_t>(before) * threads >= static_cast<std::int64_t>(zone_packs) * thread)
      return i;
    before += layout.bundles[layout.parts[i]].zone_packs();
  }
  return own.last;
}

/// Returns a sweep through bundles in order: each after the packs of faces that touch it.
template <int Dim>
std::vector<Share::Stride> strides_through(const Layout<Dim>& layout, const std::vector<int>& bundles,
                                           const std::vector<int>& packs) {
  std::vector<Share::Stride> strides;
  std::size_t next = 0;
  for (const int b : bundles) {
    std::vector<IndexRange> faces;
    for (; next < packs.size() && packs[next] <= layout.bundles[b].last_face_pack; ++next)
      append(faces, packs[next]);
    for (std::size_t i = 0; i + 1 < faces.size(); ++i) strides.push_back({faces[i], {b, b}});
    if (faces.empty() && !strides.empty() && strides.back().bundles.last == b)
      ++strides.back().bundles.last;
    else
      strides.push_back({faces.empty() ? IndexRange{} : faces.back(), {b, b + 1}});
  }
  return strides;
}

}  // namespace

template <int Dim>
std::vector<Share> share_out(const Layout<Dim>& layout, int threads, const std::vector<int>& leading) {
  std::vector<bool> leads(layout.bundles.size());
  for (const int b : leading) leads[b] = true;
  for (const int b : layout.parts) leads[b] = true;
  const auto ranges = bundle_ranges(layout, threads);
  const auto touched = bundles_of_faces(layout, leads);
  std::vector<Share> shares(threads);
  for (int t = 0; t < threads; ++t) {
    const auto mine = [&](int bundle) { return bundle >= ranges[t].first && bundle < ranges[t].last; };
    std::vector<int> bundles[2], packs[2];  // those that lead come second
    for (int b = ranges[t].first; b < ranges[t].last; ++b) bundles[leads[b] ? 1 : 0].push_back(b);
    for (int r = 0; r < layout.face_packs(); ++r) {
      // where the later bundle is of another rank, the thread of the own one takes the faces
      const int later = layout.chunks.bundles.is_own(touched[r].last) ? touched[r].last : touched[r].first;
      if (!mine(later)) continue;
      if (mine(touched[r].first) && mine(touched[r].last))
        packs[touched[r].leads ? 1 : 0].push_back(r);
      else
        append(shares[t].crossing, r);
    }
    shares[t].bundles = ranges[t];
    shares[t].corner_parts = {first_part(layout, t, threads), first_part(layout, t + 1, threads)};
    shares[t].moved_parts = parts_among(layout, ranges[t].first, ranges[t].last);
    shares[t].leading = strides_through(layout, bundles[1], packs[1]);
    shares[t].strides = strides_through(layout, bundles[0], packs[0]);
  }
  return shares;
}

template std::vector<Share> share_out(const Layout<2>&, int, const std::vector<int>&);
template std::vector<Share> share_out(const Layout<3>&, int, const std::vector<int>&);

}  // namespace pyroclast
