#include "pyroclast/base/state_copy.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

struct Thing {
  double number = 0.0;
  std::vector<int> list;
  bool has_more = false;

  void visit_state(StateVisitor& visitor) {
    const StateVisitor::Scope scope(visitor, "thing");
    visitor.visit("number", number);
    visitor.visit("list", list, state::count());
    if (has_more) visitor.visit("more", number);
  }
};

StateCopy copy_of(Thing& thing) {
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { thing.visit_state(visitor); });
  return copy;
}

TEST(StateCopy, PutsIntoOneThingWhatItTookFromAnother) {
  Thing from{2.5, {1, 2, 3}}, to{0.0, {9}};
  copy_of(from).put([&](StateVisitor& visitor) { to.visit_state(visitor); });
  EXPECT_EQ(to.number, 2.5);
  EXPECT_EQ(to.list, (std::vector<int>{1, 2, 3}));
}

TEST(StateCopy, AThingOfAnotherKindIsRefused) {
  Thing less{1.0, {}}, more{1.0, {}, true};
  EXPECT_THROW(copy_of(less).put([&](StateVisitor& visitor) { more.visit_state(visitor); }), Error);
  EXPECT_THROW(copy_of(more).put([&](StateVisitor& visitor) { less.visit_state(visitor); }), Error);
  bool flag = true;
  EXPECT_THROW(copy_of(less).put([&](StateVisitor& visitor) { visitor.visit("thing.number", flag); }), Error);
}

}  // namespace
}  // namespace pyroclast
