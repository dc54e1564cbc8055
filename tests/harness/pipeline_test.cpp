#include "routebench/harness/pipeline.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/layer_io.hpp"
#include "scratch_dir.hpp"

namespace routebench {
namespace {

std::vector<int> dense_layers(const Task& task) {
  const SlicedModel box = slice_model("shape:box?size=4", task, {}, serial_for);
  std::vector<int> dense;
  for (const Layer& layer : box.layers) {
    EXPECT_TRUE(layer.solid.empty() || layer.solid == layer.polygons);
    if (!layer.solid.empty()) dense.push_back(layer.index);
  }
  return dense;
}

TEST(SliceModel, TheTaskSaysWhichLayersAreDense) {
  Task task;
  task.layer_height_mm = 0.5;
  task.line_width_mm = 0.6;
  task.skin_layers = 1;
  EXPECT_EQ(dense_layers(task), (std::vector<int>{0, 7}));
  task.base_mm = 1;
  EXPECT_EQ(dense_layers(task), (std::vector<int>{0, 1, 7}));
  task.skin_rule = SkinRule::kSlope;
  EXPECT_EQ(dense_layers(task), (std::vector<int>{0, 1, 6, 7}));
  task.skin_rule = SkinRule::kNear;
  task.base_mm = 0;
  EXPECT_EQ(dense_layers(task), (std::vector<int>{0, 1, 6, 7}));
  task.skin_rule = SkinRule::kDifference;
  task.skin_layers = 0;
  EXPECT_TRUE(dense_layers(task).empty());
}

TEST(SliceModel, LayersOfAFileHaveNoFacets) {
  const test::ScratchDir folder;
  Task task;
  std::ostringstream layers;
  write_wkt(layers, slice_model("shape:box?size=4", task, {}, serial_for).layers);
  const std::string file = folder.write("box.wkt", layers.str()).string();
  task.skin_rule = SkinRule::kSlope;
  try {
    (void)slice_model(file, task, {}, serial_for);
    FAIL() << "it was not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_NE(std::string(error.what()).find("skin_rule"), std::string::npos);
  }
  EXPECT_FALSE(slice_model(file, task, {.find_skins = false}, serial_for).layers.empty());
}

}  // namespace
}  // namespace routebench
