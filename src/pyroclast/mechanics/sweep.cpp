#include "pyroclast/mechanics/sweep.hpp"

#include <algorithm>

namespace pyroclast {

namespace {

/// Returns the first and the last bundle that each pack of faces touches.
template <int Dim>
std::vector<IndexRange> bundles_of_faces(const Layout<Dim>& layout) {
  std::vector<int> bundle(layout.gridpoint_packs);
  for (int b = 0; b < static_cast<int>(layout.bundles.size()); ++b)
    for (int i = 0; i < layout.bundles[b].packs; ++i) bundle[layout.bundles[b].first_pack + i] = b;
  std::vector<IndexRange> touched(layout.faces.size());
  for (std::size_t r = 0; r < touched.size(); ++r) {
    const PointPack& point = layout.points[layout.first_point_of(static_cast<int>(r))];
    IndexRange range{bundle[point.a[0] / offset_of<Dim>(kLanes)], 0};
    for (int lane = 0; lane < kLanes; ++lane)
      for (int offset : {point.a[lane], point.b[lane]}) {
        const int pack = offset / offset_of<Dim>(kLanes);
        range.first = std::min(range.first, bundle[pack]);
        range.last = std::max(range.last, bundle[pack]);
      }
    touched[r] = range;
  }
  return touched;
}

void append(std::vector<IndexRange>& ranges, int i) {
  if (!ranges.empty() && ranges.back().last == i)
    ++ranges.back().last;
  else
    ranges.push_back({i, i + 1});
}

/// Returns the bundles of each thread: ranges with about the same number of zones.
template <int Dim>
std::vector<IndexRange> bundle_ranges(const Layout<Dim>& layout, int threads) {
  std::vector<IndexRange> ranges(threads);
  const int bundles = static_cast<int>(layout.bundles.size());
  int b = 0;
  for (int t = 0; t < threads; ++t) {
    ranges[t].first = b;
    const auto zone_packs = static_cast<double>(layout.zone_packs) * (t + 1) / threads;
    while (b < bundles && (t + 1 == threads || layout.bundles[b].first_zone_pack < zone_packs)) ++b;
    ranges[t].last = b;
  }
  return ranges;
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
