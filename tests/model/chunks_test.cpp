#include <cstdlib>

#include <gtest/gtest.h>

#include "model/small_specimen.hpp"
#include "pyroclast/base/error.hpp"
#include "small_chunks.hpp"

namespace pyroclast {
namespace {

TEST(Chunks, HaveFewerBlocksInSpaceThanInThePlane) {
  EXPECT_EQ(blocks_of_a_chunk(2), 1024);
  EXPECT_EQ(blocks_of_a_chunk(3), 512);
}

TEST(Chunks, HaveTheBlocksThatATestAsksFor) {
  const auto specimen = small_specimen(100);
  const SmallChunks chunks(30);
  const ModelOf<2> with_platens = between_platens(specimen, 0.01, 0.5);
  EXPECT_EQ(with_platens.chunk_blocks, (std::vector<int>{0, 1, 31, 61, 91, 101, 102}));
  EXPECT_EQ(make_model(specimen, 0.5, {}, {}).chunk_blocks, (std::vector<int>{0, 30, 60, 90, 100}));
}

TEST(Chunks, RefuseAnyOtherText) {
  for (const char* text : {"0", "-3", "12x", "many", "1e3", "99999999999"}) {
    setenv("PYROCLAST_CHUNK_BLOCKS", text, 1);
    EXPECT_THROW(blocks_of_a_chunk(2), Error) << text;
  }
  unsetenv("PYROCLAST_CHUNK_BLOCKS");
}

}  // namespace
}  // namespace pyroclast
