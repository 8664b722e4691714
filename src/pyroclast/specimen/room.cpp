#include "pyroclast/specimen/room.hpp"

#include <utility>

namespace pyroclast::specimen {

namespace {

Room<2> room_with(const Region& region, std::function<double(const Vec<2>&)> distance) {
  Room<2> room{region.box().low, region.box().high, region.extent(), {}};
  if (!region.is_rectangle()) room.distance = std::move(distance);
  return room;
}

}  // namespace

Room<2> room_in(const Region& region) {
  return room_with(region, [&region](const Vec<2>& point) { return region.distance_before_cuts(point); });
}

Room<2> room_of_blocks(const Region& region) {
  Room<2> room = room_with(region, [&region](const Vec<2>& point) { return region.distance(point); });
  if (region.is_rectangle()) return room;
  for (const Piece& piece : region.pieces()) room.lines.push_back({piece.from, piece.to});
  for (const Notch& notch : region.notches())
    if (notch.width == 0.0) room.lines.push_back({notch.mouth, notch.tip});
  return room;
}

}  // namespace pyroclast::specimen
