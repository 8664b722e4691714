#include "pyroclast/base/nearest.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace pyroclast {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsSubstitutionsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("density", "density"), 0U);
  EXPECT_EQ(edit_distance("contact", "contacts"), 1U);
  EXPECT_EQ(edit_distance("contaacts", "contacts"), 1U);
  EXPECT_EQ(edit_distance("donsity", "density"), 1U);
  EXPECT_EQ(edit_distance("heihgt", "height"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(EditDistance, IsSymmetric) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), edit_distance("sitting", "kitten"));
  EXPECT_EQ(edit_distance("ca", "abc"), edit_distance("abc", "ca"));
}

TEST(Nearest, FindsTheClosestWordWhateverItsCase) {
  const std::vector<std::string> words{"width", "height", "Poisson_ratio"};
  EXPECT_EQ(nearest("heihgt", words), 1U);
  EXPECT_EQ(nearest("WIDTH", words), 0U);
  EXPECT_EQ(nearest("poison_ratio", words), 2U);
}

TEST(Nearest, TakesTheFirstOfEqualsAndTheBestOfAll) {
  EXPECT_EQ(nearest("f_x", std::vector<std::string>{"f_t", "f_c"}), 0U);
  EXPECT_EQ(nearest("height", std::vector<std::string>{"heights", "height"}), 1U);
}

TEST(Nearest, DoesNotGuessWildly) {
  EXPECT_FALSE(nearest("thickness", std::vector<std::string>{"width", "height"}));
  EXPECT_FALSE(nearest("E", std::vector<std::string>{"G"}));
  EXPECT_FALSE(nearest("width", std::vector<std::string>{}));
}

}  // namespace
}  // namespace pyroclast
