// SPDX-License-Identifier: MIT
// Models from files and made ones, and their textures.

#include "embree/model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace embree_host {
namespace {

TEST(EmbreeTexture, WideFootprintsSeeMeans) {
  // Stripes, two texels wide, and a slope.
  const Texture texture(64, [](double u, double v) {
    return Vec3{std::fmod(32 * u, 2) < 1 ? 1.0 : 0.0, v, 0.25};
  });
  EXPECT_NEAR(texture.colour(1.0 / 64, 0.5, 0).x, 1, 1e-6) << "in the middle of a stripe";
  EXPECT_NEAR(texture.colour(3.0 / 64, 0.5, 0).x, 0, 1e-6);
  for (const double u : {0.1, 0.33, 0.7}) {
    EXPECT_NEAR(texture.colour(u, 0.4, 4.0 / 64).x, 0.5, 1e-6) << "over whole stripes";
    EXPECT_NEAR(texture.colour(u, 0.4, 1).y, 0.5, 1e-6) << "over all";
    EXPECT_NEAR(texture.colour(u, 0.4, 1e9).z, 0.25, 1e-6);
    EXPECT_NEAR(texture.colour(u, 0.4, 0).y, 0.4, 1e-6) << "linear between texels";
    EXPECT_NEAR(texture.colour(u - 3, 7.4, 0).y, 0.4, 1e-6) << "repeats";
  }
}

TEST(EmbreeTexture, OfAnySizeHasTheMeanOfItsTexels) {
  for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{5, 3}, {1, 7}, {1, 1}}) {
    std::vector<Vec3> texels;
    double sum = 0;
    for (std::size_t i = 0; i < width * height; ++i) {
      texels.push_back({static_cast<double>(i % 4), 1, 0});
      sum += texels.back().x;
    }
    const Texture texture(width, height, texels);
    EXPECT_NEAR(texture.colour(0.3, 0.6, 100).y, 1, 1e-6);
    EXPECT_LE(texture.colour(0.3, 0.6, 100).x, 3);
    if (width * height == 1) {
      EXPECT_NEAR(texture.colour(0.3, 0.6, 0).x, sum, 1e-6);
    }
  }
}

TEST(EmbreeModel, TheColonnadeHasAHundredThousandTriangles) {
  View view;
  const Model model = make_colonnade(view);
  EXPECT_GE(model.triangles.size(), 100000u);
  EXPECT_LE(model.triangles.size(), 120000u);
  ASSERT_EQ(model.material_of.size(), model.triangles.size());
  for (const Triangle& triangle : model.triangles) {
    for (const std::uint32_t corner : triangle.corners) ASSERT_LT(corner, model.vertices.size());
  }
  for (const std::uint32_t material : model.material_of)
    ASSERT_LT(material, model.materials.size());
  for (const Vertex& vertex : model.vertices) {
    const auto& [x, y, z] = vertex.normal;
    ASSERT_NEAR(std::hypot(x, y, z), 1, 1e-5);
  }
}

#ifdef EMBREE_HOST_HAS_TINYOBJ

class ObjFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("embree_obj_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    const std::string file = (folder_ / name).string();
    std::ofstream(file) << text;
    return file;
  }

  std::filesystem::path folder_;
  View view_;
};

TEST_F(ObjFile, IsReadWithMaterialsAndTurnedUpright) {
  write("m.mtl", "newmtl a\nKd 0.1 0.2 0.3\nnewmtl b\nKd 0 0 0\nmap_Kd t.pgm\n");
  write("t.pgm", "P2 2 2 255\n255 255 255 255\n");
  const Model model = read_obj(
      write("f.obj",
            "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
            "usemtl a\nf 1//1 2//1 3//1 4//1\nusemtl b\nf 1/1 2/2 3/3\n"),
      view_);
  ASSERT_EQ(model.triangles.size(), 3u) << "four corners are two triangles";
  EXPECT_EQ(model.materials[model.material_of[0]].colour.y, static_cast<double>(0.2f));
  EXPECT_FALSE(model.materials[model.material_of[0]].texture);
  ASSERT_TRUE(model.materials[model.material_of[2]].texture);
  EXPECT_EQ(model.materials[model.material_of[2]].colour.x, 1) << "black means nothing here";
  EXPECT_NEAR(model.textures[0].colour(0.5, 0.5, 0).x, 1, 1e-6);
  // y of the file is up.
  const Vertex& third = model.vertices[model.triangles[2].corners[2]];
  EXPECT_EQ(third.point, (std::array<float, 3>{1, 0, 2}));
  EXPECT_EQ(third.uv, (std::array<float, 2>{1, 1}));
  EXPECT_EQ(third.normal, (std::array<float, 3>{0, 0, 0})) << "that of the triangle";
  EXPECT_EQ(model.vertices[model.triangles[0].corners[0]].normal, (std::array<float, 3>{0, -1, 0}));
  EXPECT_LT(view_.eye.y, 0);
}

TEST_F(ObjFile, SaysWhatIsWrong) {
  const auto refused = [&](const std::string& file, const std::string& why) {
    try {
      (void)read_obj(file, view_);
      FAIL() << why;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refused((folder_ / "none.obj").string(), "none.obj");
  refused(write("empty.obj", "# nothing\n"), "has no faces");
  refused(write("far.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n"), "far.obj");
  write("m.mtl", "newmtl a\nmap_Kd gone.png\n");
  refused(write("gone.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n"),
          "gone.png");
}

#endif

}  // namespace
}  // namespace embree_host
