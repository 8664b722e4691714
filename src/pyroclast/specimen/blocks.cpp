#include "pyroclast/specimen/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/block_order.hpp"
#include "pyroclast/specimen/block_sizes.hpp"
#include "pyroclast/specimen/laguerre.hpp"
#include "pyroclast/specimen/outline_seeds.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/polyhedron.hpp"
#include "pyroclast/specimen/regularisation.hpp"
#include "pyroclast/specimen/room.hpp"
#include "pyroclast/specimen/spaced_seeds.hpp"
#include "pyroclast/specimen/stone.hpp"
#include "pyroclast/specimen/stone_seeds.hpp"
#include "pyroclast/specimen/topology.hpp"
#include "pyroclast/specimen/united_cells.hpp"
#include "pyroclast/specimen/walls.hpp"

namespace pyroclast::specimen {
namespace {

/// Largest number of rounds. Two to five rounds do for plain Voronoi seeds and edges up to 0.3 of the mean, a
/// few dozen for widely spread radii; this many mean that the parameters allow no tessellation without a
/// short edge.
constexpr int most_rounds = 60;
/// Largest number of rounds in space, where seeds that keep their distance need one.
constexpr int kMostRoundsInSpace = 20;
/// Number of places tried for a free seed before an Error says that there is none.
constexpr int kAttempts = 100'000;
/// Number of places tried before a free seed may come closer to the surface of a stone.
constexpr int kAttemptsAtOneDistance = 2000;
/// Steps of the search for the distance of seeds along stones.
template <int Dim>
constexpr int kBisections = Dim == 2 ? 14 : 8;

/// Least distance of a free seed from the surface of a stone, in spacings: at first, and where seeds find no
/// place.
constexpr double kClearOfStones = 0.75, kLeastClear = 0.45;
/// Extent of a block beside the surface of a stone, over the power of the distance of seeds.
template <int Dim>
constexpr double kBesideStone = Dim == 2 ? 0.72 : 0.5;
/// Share of its extent by which the blocks of a stone may be off, and rounds in which such blocks are
/// corrected.
constexpr double kOffInExtent = 0.005;
constexpr int kCorrections = 12;
/// Exponent of a correction. By the root one stone alone would be right at once; stones at a narrow gap move
/// facets farther.
template <int Dim>
constexpr double kCorrection = Dim == 2 ? 0.3 : 0.25;
/// Rounds after which a correction that leaves blocks unfit is taken back.
constexpr int kRoundsOfCorrection = 8;
/// Round from which a seed beside a stone whose block is unfit gives way to a free one.
constexpr int kGivesWay = 4;

/// Stones whose surfaces seeds follow, and how they do.
template <int Dim>
class Following {
 public:
  /// \param outline  seeds that the outline asks for; null in space
  Following(const BlockParameters& parameters, std::span<const Stone<Dim>> stones, const OutlineOf<Dim>& body,
            const OutlineSeeds* outline, const BlockSizes& sizes)
      : parameters_(parameters),
        stones_(stones),
        body_(body),
        outline_(outline),
        sizes_(sizes),
        ways_(stones.size()),
        aim_(stones.size(), 1.0) {
    spacing_ = spacing_along();
  }

  /// Returns the seeds along surfaces.
  const StoneSeeds<Dim>& along() const { return *along_; }

  /// Places the seeds along surfaces anew, farther from each other by a factor.
  void follow_wider(double factor) { follow(spacing_ *= factor); }

  /// Follows stones whose blocks are too large or too small as larger or smaller ones, and small stones that
  /// did not become one block by one seed. Tells whether there was one.
  /// \param stone        stone of each cell, -1: of none
  /// \param are_regular  true for blocks that are regularised: then others are aimed at before that
  bool correct(const Cells<Dim>& cells, const std::vector<int>& stone, bool are_regular = false) {
    struct OfStone {
      int count = 0;
      double extent = 0.0;  ///< of its blocks
    };
    std::vector<OfStone> blocks(stones_.size());
    for (std::size_t cell = 0; cell < stone.size(); ++cell) {
      if (stone[cell] < 0) continue;
      blocks[stone[cell]].extent += extent(cells, cell);
      ++blocks[stone[cell]].count;
    }
    bool is_off = false;
    for (std::size_t i = 0; i < stones_.size(); ++i) {
      if (blocks[i].count > 1 && along_->is_one_cell(static_cast<int>(i)) && !ways_[i].is_of_one_seed) {
        ways_[i] = {1.0, true};
        is_off = true;
        continue;
      }
      double share = blocks[i].extent / ((are_regular ? 1.0 : aim_[i]) * extent(stones_[i]));
      if (std::abs(share - 1.0) < (are_regular ? 2.0 : 1.0) * kOffInExtent) continue;
      is_off = true;
      if (are_regular) share = std::clamp(share, 0.9, 1.1);
      if (are_regular) aim_[i] /= share;
      ways_[i].size *= std::clamp(std::pow(share, -kCorrection<Dim>), 0.95, 1.05);
    }
    return is_off;
  }

  /// Calls f(stone, whether the stone is one block) for each block that seeds along stones make: the cells of
  /// a small stone become one. The stone is -1 between stones.
  template <class F>
  void for_each_block(const std::vector<int>& owners, F&& f) const {
    std::vector<char> has_one(stones_.size(), 0);
    for (const int stone : owners) {
      const bool is_one = stone >= 0 && along_->is_one_cell(stone);
      if (!is_one || !std::exchange(has_one[stone], 1)) f(stone, is_one);
    }
  }

 private:
  void follow(double spacing) { along_.emplace(stones_, ways_, body_, outline_, sizes_.scaled_to(spacing)); }

  static double power(double length) { return Dim == 2 ? length * length : length * length * length; }

  /// Finds the distance of seeds along surfaces with which all blocks are about as large, those beside a
  /// surface and the free ones, m. Throws Error where there are not enough blocks.
  double spacing_along() {
    const double room =
        parameters_.count - (outline_ ? static_cast<double>(outline_->positions().size()) : 0.0);
    const auto too_many = [&](double spacing) {
      follow(spacing);
      // extent in which blocks of the mean size would be as many
      double blocks = 0.0, extent_left = body_.extent();
      for_each_block(along_->owners(), [&](int stone, bool is_one) {
        ++blocks;
        extent_left -= is_one ? extent(stones_[stone]) / power(sizes_.relative(stones_[stone].centre))
                              : kBesideStone<Dim> * power(spacing);
      });
      return blocks + std::max(0.0, extent_left / power(spacing)) > room;
    };
    double low = 0.5 * sizes_.mean(), high = 3.0 * sizes_.mean();
    for (int i = 0; i < kBisections<Dim>; ++i) {
      const double middle = std::sqrt(low * high);
      (too_many(middle) ? low : high) = middle;
    }
    if (too_many(high))
      throw Error(fmt::format("{}{} blocks are too few to follow the surfaces of {} stones: take more",
                              parameters_.place.empty() ? "" : parameters_.place + ": ", parameters_.count,
                              stones_.size()));
    return high;
  }

  const BlockParameters& parameters_;
  std::span<const Stone<Dim>> stones_;
  const OutlineOf<Dim>& body_;
  const OutlineSeeds* outline_;
  const BlockSizes& sizes_;
  std::vector<WayToFollow> ways_;
  std::vector<double> aim_;  ///< extent of the blocks of each stone before they are regularised, over its own
  double spacing_ = 0.0;     ///< mean distance of seeds along surfaces, m
  std::optional<StoneSeeds<Dim>> along_;
};

/// Seeds of a region: first the seeds that its outline asks for, then those along the surfaces of stones,
/// then the free ones.
class SeedDraw {
 public:
  SeedDraw(const BlockParameters& parameters, const Region& region, std::span<const Stone<2>> stones,
           Random& random)
      : parameters_(parameters),
        region_(region),
        random_(random),
        sizes_(sizes_of<2>(parameters, region)),
        outline_(region, sizes_) {
    if (!sizes_.is_even()) places_.emplace(room_of_blocks(region), sizes_);
    kept_ = outline_.positions().size();
    if (static_cast<int>(kept_) > parameters.count)
      throw Error(fmt::format("{} blocks are too few for this outline: it takes {} by itself",
                              parameters.count, kept_));
    seeds.position = outline_.positions();
    seeds.radius = outline_.radii();
    owner_.assign(kept_, -1);
    if (!stones.empty()) {
      following_.emplace(parameters, stones, region, &outline_, sizes_);
      add_along();
    }
    fill_up();
  }

  /// Draws the seeds of unfit blocks anew. A seed along a stone whose cell is empty, or stays unfit, gives
  /// way. Where the outline asks for a seed, or a stone does, the free seed nearest to it is drawn anew
  /// instead. A radius stays with its seed, or the cells of small radii would die out.
  /// \param unfit  seeds, ascending
  void redraw(const std::vector<int>& unfit, bool are_empty, int round) {
    std::vector<std::size_t> numbers;
    for (auto seed = unfit.rbegin(); seed != unfit.rend(); ++seed) {  // Clang 14 cannot do views::reverse
      const auto number = static_cast<std::size_t>(*seed);
      const bool is_of_stone = number >= outline_.positions().size() && number < kept_;
      if (is_of_stone && (are_empty || round >= kGivesWay)) {
        drop(number);
        for (std::size_t& other : numbers) --other;
      } else {
        numbers.push_back(number);
      }
    }
    for (auto number = numbers.rbegin(); number != numbers.rend(); ++number) redraw(*number);
    fill_up();
  }

  /// Corrects how stones are followed, see Following::correct. Tells whether that changed.
  bool correct(const Blocks<2>& blocks) {
    if (!following_ || !following_->correct(blocks.cells, blocks.stone)) return false;
    const auto first_free = static_cast<std::ptrdiff_t>(kept_);
    const Seeds<2> free{{seeds.position.begin() + first_free, seeds.position.end()},
                        {seeds.radius.begin() + first_free, seeds.radius.end()}};
    kept_ = outline_.positions().size();
    seeds.position.resize(kept_);
    seeds.radius.resize(kept_);
    owner_.resize(kept_);
    following_->follow_wider(1.0);
    add_along();
    const auto missing = static_cast<std::size_t>(std::max(0, parameters_.count - block_count()));
    const auto count = static_cast<std::ptrdiff_t>(std::min(free.position.size(), missing));
    seeds.position.insert(seeds.position.end(), free.position.begin(), free.position.begin() + count);
    seeds.radius.insert(seeds.radius.end(), free.radius.begin(), free.radius.begin() + count);
    fill_up();
    return true;
  }

  std::size_t kept() const { return kept_; }
  const BlockSizes& sizes() const { return sizes_; }

  /// Returns the stone of each seed, index into the stones, -1: of none; empty where blocks do not follow
  /// stones.
  std::vector<int> owners(const std::vector<Vec<2>>& positions) const {
    if (!following_) return {};
    std::vector<int> result = owner_;
    for (std::size_t i = kept_; i < positions.size(); ++i)
      result.push_back(following_->along().stone_at(positions[i]));
    return result;
  }

  bool is_one_cell(int stone) const { return following_->along().is_one_cell(stone); }

  Seeds<2> seeds;

 private:
  /// Returns the number of blocks of the seeds.
  int block_count() const {
    auto count = static_cast<int>(seeds.position.size() - (following_ ? kept_ : 0));
    if (following_) following_->for_each_block(owner_, [&](int, bool) { ++count; });
    return count;
  }

  /// Adds free seeds up to the number of blocks asked for.
  void fill_up() {
    const double spread = parameters_.radius_spread;
    for (int i = block_count(); i < parameters_.count; ++i) {
      seeds.position.push_back(free_position());
      const double half = 0.5 * sizes_.at(seeds.position.back());
      seeds.radius.push_back(half * random_.uniform(1.0 - spread, 1.0 + spread));
    }
  }

  void drop(std::size_t number) {
    const auto at = static_cast<std::ptrdiff_t>(number);
    seeds.position.erase(seeds.position.begin() + at);
    seeds.radius.erase(seeds.radius.begin() + at);
    owner_.erase(owner_.begin() + at);
    --kept_;
  }

  void redraw(std::size_t unfit) {
    const std::size_t first = kept_;
    if (first == seeds.position.size()) return;
    if (unfit < first) {
      const Vec<2> at = seeds.position[unfit];
      const auto nearest =
          std::min_element(seeds.position.begin() + static_cast<std::ptrdiff_t>(first), seeds.position.end(),
                           [&](const Vec<2>& a, const Vec<2>& b) { return norm(a - at) < norm(b - at); });
      unfit = static_cast<std::size_t>(nearest - seeds.position.begin());
    }
    const Vec<2> place = free_position();
    if (!sizes_.is_even()) seeds.radius[unfit] *= sizes_.at(place) / sizes_.at(seeds.position[unfit]);
    seeds.position[unfit] = place;
  }

  void add_along() {
    const StoneSeeds<2>& along = following_->along();
    seeds.position.insert(seeds.position.end(), along.positions().begin(), along.positions().end());
    seeds.radius.insert(seeds.radius.end(), along.radii().begin(), along.radii().end());
    owner_.insert(owner_.end(), along.owners().begin(), along.owners().end());
    kept_ = seeds.position.size();
  }

  Vec<2> anywhere() {
    const Box& box = region_.box();
    const double x = random_.uniform(box.low[0], box.high[0]);
    return {{x, random_.uniform(box.low[1], box.high[1])}};
  }

  Vec<2> free_position() {
    double clear = kClearOfStones;
    for (int attempt = 1; attempt <= kAttempts; ++attempt) {
      const Vec<2> position = places_ ? places_->draw(random_) : anywhere();
      if (attempt % kAttemptsAtOneDistance == 0) clear = std::max(kLeastClear, clear - 0.05);
      const bool is_free = region_.is_rectangle() || outline_.leave_room_at(position);
      if (is_free && (!following_ || following_->along().leave_room_at(position, clear))) return position;
    }
    throw Error(
        fmt::format("no place for a seed was found in {} attempts: blocks of {:.3g} mm are too large for "
                    "this outline",
                    kAttempts, 1e3 * sizes_.mean()));
  }

  const BlockParameters& parameters_;
  const Region& region_;
  Random& random_;
  BlockSizes sizes_;
  std::optional<PlaceDraw<2>> places_;  ///< where blocks are not alike
  OutlineSeeds outline_;
  std::optional<Following<2>> following_;
  std::vector<int> owner_;  ///< stone of each seed that is kept, -1: of none
  std::size_t kept_ = 0;    ///< number of seeds that the outline and stones ask for
};

/// Returns the name of the side of the outline that is nearest to a point.
std::string side_near(const Region& region, const Vec<2>& point) {
  const auto nearest = std::ranges::min_element(region.pieces(), {}, [&](const Piece& piece) {
    return distance_from_segment(point, piece.from, piece.to);
  });
  return region.sides()[nearest->side].name;
}

/// Makes one cell of the cells of each small stone, where it is convex. Cells keep their order by their first
/// one.
/// \param stone  stone of each cell; follows
/// \param seed   seed of each cell; follows
void unite_small_stones(const SeedDraw& draw, Cells<2>& cells, std::vector<int>& stone,
                        std::vector<int>& seed) {
  std::map<int, std::vector<int>> small;
  for (std::size_t c = 0; c < stone.size(); ++c)
    if (stone[c] >= 0 && draw.is_one_cell(stone[c])) small[stone[c]].push_back(static_cast<int>(c));
  std::vector<std::vector<int>> groups;
  for (auto& [number, its] : small) groups.push_back(std::move(its));
  const std::vector<int> before = unite(cells, groups);
  for (std::size_t c = 0; c < before.size(); ++c) {
    stone[c] = stone[before[c]];
    seed[c] = seed[before[c]];
  }
  stone.resize(before.size());
  seed.resize(before.size());
}

Blocks<2> tessellate_until_fit(const BlockParameters& parameters, const Region& region,
                               std::span<const Stone<2>> stones, Random& random, Team* team) {
  SeedDraw draw(parameters, region, stones, random);
  Blocks<2> blocks{};
  std::optional<Blocks<2>> fit;
  int corrections = 0;
  while (true) {
    ++blocks.rounds;
    Seeds<2> seeds = draw.seeds;
    for (int i = 0; i < parameters.relaxation; ++i) relax(seeds, region, draw.kept(), team, draw.sizes());
    Laguerre<2> result = laguerre_cells(seeds, region, team);
    std::vector<int> unfit = std::move(result.broken);
    const bool are_empty = !unfit.empty();
    if (!are_empty) {
      std::vector<int> seed(seeds.position.size());
      std::iota(seed.begin(), seed.end(), 0);
      blocks.stone = draw.owners(seeds.position);
      if (!stones.empty()) unite_small_stones(draw, result.cells, blocks.stone, seed);
      const RegularisedCells done =
          regularise(result.cells, region, {parameters.shortest_edge}, draw.sizes());
      blocks.cells = std::move(result.cells);
      blocks.done.vertices_merged = done.vertices_merged;
      blocks.done.edges_left_short = done.edges_left_short;
      for (const int cell : done.unfit) unfit.push_back(seed[cell]);
      std::ranges::sort(unfit);
    }
    if (unfit.empty()) {
      if (corrections == kCorrections || !draw.correct(blocks)) return blocks;
      ++corrections;
      fit = blocks;
      continue;
    }
    if (fit && blocks.rounds >= fit->rounds + kRoundsOfCorrection) return std::move(*fit);
    if (blocks.rounds == most_rounds) {
      if (!blocks.cells.cells.empty()) return blocks;
      const Vec<2> at = seeds.position[static_cast<std::size_t>(unfit.front())];
      throw Error(
          fmt::format("{}no tessellation of {} blocks came about in {} rounds: {} cells stay empty or unfit, "
                      "the first near ({:.6g}, {:.6g}) m at the side \"{}\". The part of the outline there "
                      "must be some three blocks wide: take more blocks (count){}",
                      parameters.place.empty() ? "" : parameters.place + ": ", parameters.count, most_rounds,
                      unfit.size(), at[0], at[1], side_near(region, at),
                      parameters.radius_spread > 0.0 ? ", or blocks more alike (radius_spread)" : ""));
    }
    draw.redraw(unfit, are_empty, blocks.rounds - (fit ? fit->rounds : 0));
    blocks.done.seeds_redrawn += static_cast<int>(unfit.size());
  }
}

/// Factor of the distance of seeds along stones where these take more than all blocks.
constexpr double kWider = 1.02;
/// Times that blocks are regularised in all; after the first one stones whose volume is off are corrected.
constexpr int kRegularisations = 2;
/// Places tried before a free seed may come a step closer to the surface of a stone.
constexpr int kTriesAtOneDistance = 500;
/// Owner of the seeds whose cells are taken out.
constexpr int kWithinCut = std::numeric_limits<int>::max() / 4;

/// Seeds in space of which some stand in pairs along the surfaces of stones, or along the walls of holes and
/// notches, in the order of a curve through the body.
class FollowingSeeds {
 public:
  FollowingSeeds(const BlockParameters& parameters, const Prism& body, std::span<const Stone<3>> stones,
                 const BlockSizes& sizes, Random& random)
      : parameters_(parameters),
        body_(body),
        sizes_(sizes),
        random_(random),
        following_(parameters, stones, body, nullptr, sizes),
        walls_(wall_seeds(body, sizes)) {
    make({});
  }

  /// Draws seeds whose cells fail anew, without a surface.
  void redraw(const std::vector<int>& which) {
    std::vector<Vec<3>> standing;
    for (std::size_t i = 0; i < owner.size(); ++i)
      if (!std::ranges::binary_search(which, static_cast<int>(i))) standing.push_back(seeds.position[i]);
    SpacedSeedDraw draw = free_draw(standing);
    for (const int i : which) {
      put_free(static_cast<std::size_t>(i), draw.draw());
      is_free_[static_cast<std::size_t>(i)] = 1;
    }
  }

  /// Corrects how stones are followed, see Following::correct. Tells whether that changed, and then makes the
  /// seeds anew.
  bool correct(const Cells<3>& cells, bool are_regular) {
    if (!following_.correct(cells, owner, are_regular)) return false;
    before_.emplace(seeds, owner, is_free_);
    std::vector<Vec<3>> free;
    for (std::size_t i = 0; i < owner.size(); ++i)
      if (is_free_[i]) free.push_back(seeds.position[i]);
    following_.follow_wider(1.0);
    make(free);
    return true;
  }

  /// Takes back the last correction, after which cells fail. Returns false where there was none.
  bool take_back() {
    if (!before_) return false;
    std::tie(seeds, owner, is_free_) = std::move(*before_);
    before_.reset();
    return true;
  }

  Seeds<3> seeds;
  std::vector<int> owner;  ///< stone of each seed, -1: of none; kWithinCut within holes and notches

 private:
  /// Places the seeds along surfaces, and free ones up to the number of blocks.
  /// \param places  places of free seeds, taken as far as they are needed
  void make(const std::vector<Vec<3>>& places) {
    const auto within = static_cast<std::size_t>(std::ranges::count(walls_.are_within, 1));
    const std::size_t count = parameters_.count + within;
    while (along().owners().size() > count) following_.follow_wider(kWider);
    seeds.position = along().positions();
    seeds.radius = along().radii();
    owner = along().owners();
    for (std::size_t i = 0; i < walls_.positions.size(); ++i) {
      seeds.position.push_back(walls_.positions[i]);
      seeds.radius.push_back(walls_.radii[i]);
      owner.push_back(walls_.are_within[i] ? kWithinCut : -1);
    }
    is_free_.assign(owner.size(), 0);
    for (const Vec<3>& place : places)
      if (owner.size() < count && along().leave_room_at(place, kLeastClear)) add_free(place);
    if (owner.size() < count) {
      SpacedSeedDraw draw = free_draw(seeds.position);
      while (owner.size() < count) add_free(draw.draw());
    }
    sort();
  }

  const StoneSeeds<3>& along() const { return following_.along(); }

  SpacedSeedDraw free_draw(const std::vector<Vec<3>>& standing) {
    SpacedSeedDraw draw(body_, sizes_, random_, [this](const Vec<3>& place, int tried) {
      const double clear = std::max(kLeastClear, kClearOfStones - 0.05 * (tried / kTriesAtOneDistance));
      return along().leave_room_at(place, clear) &&
             body_.distance_from_walls(place) >= clear * sizes_.at(place);
    });
    for (const Vec<3>& place : standing) draw.add(place);
    return draw;
  }

  void add_free(const Vec<3>& place) {
    seeds.position.emplace_back();
    seeds.radius.emplace_back();
    owner.emplace_back();
    is_free_.push_back(1);
    put_free(owner.size() - 1, place);
  }

  void put_free(std::size_t i, const Vec<3>& place) {
    const double spread = parameters_.radius_spread;
    seeds.position[i] = place;
    seeds.radius[i] = 0.5 * sizes_.at(place) * random_.uniform(1.0 - spread, 1.0 + spread);
    owner[i] = along().stone_at(place);
  }

  void sort() {
    const auto order = order_along_curve(seeds.position, body_);
    const auto sorted = [&](auto& values) {
      auto before = std::exchange(values, {});
      for (const std::size_t i : order) values.push_back(before[i]);
    };
    sorted(seeds.position);
    sorted(seeds.radius);
    sorted(owner);
    sorted(is_free_);
  }

  const BlockParameters& parameters_;
  const Prism& body_;
  const BlockSizes& sizes_;
  Random& random_;
  Following<3> following_;
  WallSeeds walls_;
  std::vector<char> is_free_;                                                        ///< of each seed
  std::optional<std::tuple<Seeds<3>, std::vector<int>, std::vector<char>>> before_;  ///< the last correction
};

/// Returns the cells that cannot be blocks: vertices that lie nearly in one place were joined.
std::vector<int> faulty_cells(const Cells<3>& cells) {
  std::vector<int> faulty;
  for (std::size_t cell = 0; cell < cells.cells.size(); ++cell)
    if (fault_of(cells, cell)) faulty.push_back(static_cast<int>(cell));
  return faulty;
}

/// Adds the sizes that blocks were to have, where they are not alike.
template <int Dim>
void add_sizes(const BlockSizes& sizes, Blocks<Dim>& blocks) {
  if (sizes.is_even()) return;
  for (std::size_t cell = 0; cell < blocks.cells.cells.size(); ++cell)
    blocks.size.push_back(sizes.at(centroid(blocks.cells, cell)));
}

}  // namespace

Blocks<2> make_blocks(const BlockParameters& parameters, const Region& region, Random& random, Team* team,
                      std::span<const Stone<2>> stones) {
  Blocks<2> blocks{};
  if (!parameters.cells) {
    blocks = tessellate_until_fit(parameters, region, stones, random, team);
    require_valid(blocks.cells, region, fmt::format("Tessellation of {} blocks", parameters.count));
  } else {
    blocks.cells = *parameters.cells;
    const RegularisedCells done = regularise(blocks.cells, region, {parameters.shortest_edge});
    blocks.done.vertices_merged = done.vertices_merged;
    blocks.done.edges_left_short = done.edges_left_short;
  }
  const std::vector<int> stone = std::exchange(blocks.stone, {});
  const BlockSizes sizes = sizes_of<2>(parameters, region);
  for (const std::size_t before : number_along_curve(blocks.cells, region.box())) {
    if (!parameters.phase.empty()) blocks.phase.push_back(parameters.phase[before]);
    if (!stone.empty()) blocks.stone.push_back(stone[before]);
  }
  add_sizes(sizes, blocks);
  return blocks;
}

Blocks<3> make_blocks(const BlockParameters& parameters, const Prism& body, Random& random, Team* team,
                      std::span<const Stone<3>> stones) {
  const BlockSizes sizes = sizes_of<3>(parameters, body);
  std::optional<FollowingSeeds> following;
  const bool has_walls = !body.walls().empty();
  if (has_walls && !stones.empty())
    throw Error(
        fmt::format("{}blocks of a solid with holes or notches cannot follow stones yet: "
                    "[superposition] rule = \"each\"",
                    parameters.place.empty() ? "" : parameters.place + ": "));
  if (has_walls || !stones.empty()) following.emplace(parameters, body, stones, sizes, random);
  Seeds<3> free;
  if (!following) free = spaced_seeds(body, sizes, parameters.count, parameters.radius_spread, random);
  Seeds<3>& seeds = following ? following->seeds : free;
  const std::string what = fmt::format("Tessellation of {} blocks", parameters.count);
  Blocks<3> blocks;
  int corrections = 0, regularisations = 0, most_corrections = stones.empty() ? 0 : kCorrections;
  for (int failed = 0; failed < kMostRoundsInSpace; ++blocks.rounds) {
    Laguerre<3> result = laguerre_cells(seeds, body, team);
    if (result.broken.empty()) result.broken = faulty_cells(result.cells);
    if (!result.broken.empty()) {
      blocks.done.seeds_redrawn += static_cast<int>(result.broken.size());
      if (++failed > kRoundsOfCorrection && following && following->take_back())
        most_corrections = corrections;
      else if (following)
        following->redraw(result.broken);
      else
        redraw(seeds, result.broken, body, sizes, random);
      continue;
    }
    failed = 0;
    if (following && corrections < most_corrections && following->correct(result.cells, false)) {
      ++corrections;
      continue;
    }
    if (following) blocks.stone = following->owner;
    if (parameters.shortest_edge > 0.0) {
      const auto regular =
          regularise(result.cells, body, result.plane, {parameters.shortest_edge, parameters.largest_bend},
                     sizes, blocks.stone);
      blocks.done.vertices_merged = regular.vertices_merged;
      blocks.done.edges_left_short = regular.edges_left_short;
    }
    require_valid(result.cells, body, what);
    if (parameters.shortest_edge > 0.0 && following && ++regularisations < kRegularisations &&
        most_corrections > corrections && following->correct(result.cells, true)) {
      most_corrections += kCorrections;
      continue;
    }
    blocks.cells = std::move(result.cells);
    if (has_walls) {
      std::vector<char> is_out;
      for (const int owner : std::exchange(blocks.stone, {})) is_out.push_back(owner == kWithinCut ? 1 : 0);
      take_out(blocks.cells, is_out, body);
      require_filled(blocks.cells, body, what);
    }
    add_sizes(sizes, blocks);
    return blocks;
  }
  throw Error(fmt::format(
      "{}no tessellation of {} blocks came about in {} rounds: take blocks that are more "
      "alike (radius_spread), or another seed",
      parameters.place.empty() ? "" : parameters.place + ": ", parameters.count, kMostRoundsInSpace));
}

}  // namespace pyroclast::specimen
