#include "pyroclast/mechanics/sweep.hpp"

#include <algorithm>

namespace pyroclast {

namespace {

/// Time in which a piece is moved, its corner forces being there, over that of as many zones of an alike
/// bundle with its faces (20,000 blocks on one thread: 2.4 and 6.1 ns a zone).
constexpr double kPieceCost = 0.4;

double cost(const Bundle& bundle) {
  return bundle.zone_packs() * (bundle.kind == BundleKind::piece ? kPieceCost : 1.0);
}

/// Returns the first and the last bundle that each pack of faces touches.
template <int Dim>
std::vector<IndexRange> bundles_of_faces(const Layout<Dim>& layout) {
  std::vector<IndexRange> touched;
  for (int r = 0; r < layout.face_packs(); ++r) {
    const int first_point = layout.first_point_of(r), last_point = layout.first_point_of(r + 1);
    IndexRange range{static_cast<int>(layout.bundles.size()), 0};
    for (int point = first_point; point < last_point; ++point)
      for (int lane = 0; lane < kLanes; ++lane)
        for (int offset : {layout.points[point].a[lane], layout.points[point].b[lane]}) {
          const int bundle = layout.bundle_of_pack[offset / offset_of<Dim>(kLanes)];
          range.first = std::min(range.first, bundle);
          range.last = std::max(range.last, bundle);
        }
    touched.push_back(range);
  }
  return touched;
}

void append(std::vector<IndexRange>& ranges, int i) {
  if (!ranges.empty() && ranges.back().last == i)
    ++ranges.back().last;
  else
    ranges.push_back({i, i + 1});
}

/// Returns the bundles of each thread: ranges that cost about the same.
template <int Dim>
std::vector<IndexRange> bundle_ranges(const Layout<Dim>& layout, int threads) {
  std::vector<IndexRange> ranges(threads);
  const int bundles = static_cast<int>(layout.bundles.size());
  double total = 0.0, taken = 0.0;
  for (const Bundle& bundle : layout.bundles) total += cost(bundle);
  int b = 0;
  for (int t = 0; t < threads; ++t) {
    ranges[t].first = b;
    while (b < bundles && (t + 1 == threads || taken < total * (t + 1) / threads))
      taken += cost(layout.bundles[b++]);
    ranges[t].last = b;
  }
  return ranges;
}

/// Returns the first piece whose corner forces a thread computes; all have about as many zones to do.
template <int Dim>
int first_piece(const Layout<Dim>& layout, int thread, int threads) {
  const auto zone_packs = static_cast<double>(layout.piece_zones.size()) * thread / threads;
  const auto is_before = [&](int piece) { return layout.bundles[piece].first_corners < zone_packs; };
  return static_cast<int>(std::ranges::partition_point(layout.pieces, is_before) - layout.pieces.begin());
}

}  // namespace

template <int Dim>
std::vector<Share> share_out(const Layout<Dim>& layout, int threads) {
  const auto ranges = bundle_ranges(layout, threads);
  const auto touched = bundles_of_faces(layout);
  std::vector<Share> shares(threads);
  for (int t = 0; t < threads; ++t) {
    const auto mine = [&](int bundle) { return bundle >= ranges[t].first && bundle < ranges[t].last; };
    std::vector<int> packs;
    for (int r = 0; r < layout.face_packs(); ++r) {
      if (!mine(touched[r].last)) continue;
      if (mine(touched[r].first))
        packs.push_back(r);
      else
        append(shares[t].crossing, r);
    }
    const auto pieces_before = [&](int bundle) {
      return static_cast<int>(std::ranges::lower_bound(layout.pieces, bundle) - layout.pieces.begin());
    };
    shares[t].corner_pieces = {first_piece(layout, t, threads), first_piece(layout, t + 1, threads)};
    shares[t].moved_pieces = {pieces_before(ranges[t].first), pieces_before(ranges[t].last)};
    auto& strides = shares[t].strides;
    std::size_t next = 0;
    for (int b = ranges[t].first; b < ranges[t].last; ++b) {
      std::vector<IndexRange> faces;
      for (; next < packs.size() && packs[next] <= layout.bundles[b].last_face_pack; ++next)
        append(faces, packs[next]);
      for (std::size_t i = 0; i + 1 < faces.size(); ++i) strides.push_back({faces[i], {b, b}});
      if (faces.empty() && !strides.empty())
        strides.back().bundles.last = b + 1;
      else
        strides.push_back({faces.empty() ? IndexRange{} : faces.back(), {b, b + 1}});
    }
  }
  return shares;
}

template std::vector<Share> share_out(const Layout<2>&, int);
template std::vector<Share> share_out(const Layout<3>&, int);

}  // namespace pyroclast
