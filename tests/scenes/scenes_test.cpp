#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "scenes/area.h"
#include "scenes/random.h"
#include "scenes/scene.h"

namespace {

using Color = std::array<float, 3>;

Color radiance(const scenes::Scene& scene, double x, double y, std::uint64_t id = 0) {
  Color rgb{};
  scene.radiance(x, y, id, rgb);
  return rgb;
}

std::unique_ptr<scenes::Scene> make(std::string_view name, int width, int height,
                                    std::uint64_t seed = 0) {
  return scenes::make_scene(
      {.name = std::string(name), .width = width, .height = height, .seed = seed});
}

const std::set<std::string_view> noisy_names{"softshadow", "dof", "glossy"};

/// Positions and ids of samples.
struct Samples {
  std::vector<double> x, y;
  std::vector<std::uint64_t> id;

  Samples(std::size_t count, int width, int height) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> across(0, width), down(0, height);
    for (std::size_t i = 0; i < count; ++i) {
      x.push_back(across(random));
      y.push_back(down(random));
      id.push_back(random());
    }
  }
};

TEST(Scenes, AreFiniteAndNotNegativeEverywhere) {
  constexpr std::array<std::array<int, 2>, 4> sizes{{{97, 61}, {1, 1}, {3, 200}, {300, 2}}};
  for (const std::string_view name : scenes::scene_names()) {
    for (const auto& [width, height] : sizes) {
      const auto scene = make(name, width, height);
      Samples at(5000, width, height);
      for (const double x : {0, width}) {
        for (const double y : {0, height}) {
          at.x.push_back(x);
          at.y.push_back(y);
          at.id.push_back(0);
        }
      }
      for (std::size_t i = 0; i < at.x.size(); ++i) {
        for (const float value : radiance(*scene, at.x[i], at.y[i], at.id[i])) {
          ASSERT_TRUE(std::isfinite(value) && value >= 0)
              << name << " at " << at.x[i] << ", " << at.y[i];
        }
      }
    }
  }
}

// Two objects, the second used by several threads, each in an order of its own.
TEST(Scenes, GiveTheSameValueWhoeverAsks) {
  constexpr std::size_t count = 2000;
  constexpr std::size_t threads = 4;
  const Samples at(count, 97, 61);
  for (const std::string_view name : scenes::scene_names()) {
    const auto scene = make(name, 97, 61);
    std::vector<Color> expected;
    for (std::size_t i = 0; i < count; ++i) {
      expected.push_back(radiance(*scene, at.x[i], at.y[i], at.id[i]));
    }
    const auto shared = make(name, 97, 61);
    std::array<std::size_t, threads> different{};
    {
      std::vector<std::jthread> running;
      for (std::size_t thread = 0; thread < threads; ++thread) {
        running.emplace_back([&, thread] {
          for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = (count * thread / threads + count - 1 - k) % count;
            if (radiance(*shared, at.x[i], at.y[i], at.id[i]) != expected[i]) ++different[thread];
          }
        });
      }
    }
    for (const std::size_t each : different) EXPECT_EQ(each, 0u) << name;
  }
}

TEST(Scenes, SayWhetherTheyAreNoisy) {
  const Samples at(1000, 97, 61);
  for (const std::string_view name : scenes::scene_names()) {
    const auto scene = make(name, 97, 61);
    EXPECT_EQ(scene->noisy(), noisy_names.contains(name)) << name;
    std::size_t different = 0;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      const Color one = radiance(*scene, at.x[i], at.y[i], at.id[i]);
      if (one != radiance(*scene, at.x[i], at.y[i], at.id[i] + 1)) ++different;
    }
    if (scene->noisy()) {
      EXPECT_GT(different, at.x.size() / 2) << name;
    } else {
      EXPECT_EQ(different, 0u) << name;
    }
  }
}

TEST(Scenes, LookTheSameAtEverySize) {
  constexpr std::size_t count = 2000;
  const Samples at(count, 64, 48);
  // Not the zone plates, whose frequency is given per pixel, nor the dots.
  for (const std::string_view name : {"fan", "chess", "star", "checker", "gradient", "corner",
                                      "edge", "sun", "softshadow", "dof", "glossy"}) {
    const auto small = make(name, 64, 48);
    const auto large = make(name, 256, 192);
    std::size_t different = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Color a = radiance(*small, at.x[i], at.y[i], at.id[i]);
      const Color b = radiance(*large, 4 * at.x[i], 4 * at.y[i], at.id[i]);
      for (std::size_t c = 0; c < 3; ++c) {
        if (std::abs(a[c] - b[c]) > 1e-4f * (1 + a[c])) ++different;
      }
    }
    // Rounding may put a sample on the other side of an edge.
    EXPECT_LE(different, 3 * count / 500) << name;
  }
}

/// Mean and variance of the mean of a scene's green at one place.
struct Estimate {
  double mean = 0, variance = 0;

  Estimate(const scenes::Scene& scene, double x, double y, std::uint64_t first_id,
           std::size_t count) {
    const auto n = static_cast<double>(count);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double value = radiance(scene, x, y, first_id + i)[1];
      sum += value;
      squares += value * value;
    }
    mean = sum / n;
    variance = std::max(0.0, squares / n - mean * mean) / n;
  }
};

// Counting ids must do as well as random ones, as that is how a renderer names its samples.
TEST(NoisyScenes, ConvergeToOneMeanForAllIdsAndSeeds) {
  constexpr std::size_t count = 2000;
  constexpr std::size_t places = 40;
  const Samples at(places, 97, 61);
  for (const std::string_view name : noisy_names) {
    const auto scene = make(name, 97, 61);
    const auto reseeded = make(name, 97, 61, 5);
    std::size_t noisy = 0;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < places; ++i) {
      const double x = at.x[i];
      const double y = at.y[i];
      const Estimate a(*scene, x, y, 0, count);
      const Estimate b(*scene, x, y, count, count);
      const Estimate c(*reseeded, x, y, 0, count);
      EXPECT_LE(std::abs(a.mean - b.mean), 5 * std::sqrt(a.variance + b.variance) + 1e-6) << name;
      EXPECT_LE(std::abs(a.mean - c.mean), 5 * std::sqrt(a.variance + c.variance) + 1e-6) << name;
      if (a.variance > 1e-12) ++noisy;
      if (a.mean != c.mean) ++changed;
    }
    EXPECT_GT(noisy, places / 4) << name;
    EXPECT_GE(changed, noisy) << name;
  }
}

TEST(NoisyScenes, NeighbouringIdsAreNotCorrelated) {
  constexpr std::size_t count = 4000;
  const Samples at(20, 97, 61);
  for (const std::string_view name : noisy_names) {
    const auto scene = make(name, 97, 61);
    std::size_t checked = 0;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      const Estimate whole(*scene, at.x[i], at.y[i], 0, count);
      const double variance = whole.variance * static_cast<double>(count);
      if (variance < 1e-6) continue;
      double covariance = 0;
      double before = radiance(*scene, at.x[i], at.y[i], count)[1] - whole.mean;
      for (std::uint64_t id = 0; id < count; ++id) {
        const double now = radiance(*scene, at.x[i], at.y[i], id)[1] - whole.mean;
        covariance += before * now / static_cast<double>(count);
        before = now;
      }
      EXPECT_LT(std::abs(covariance / variance), 5 / std::sqrt(count)) << name;
      ++checked;
    }
    EXPECT_GT(checked, 3u) << name;
  }
}

TEST(Random, IsUniform) {
  constexpr int count = 20000;
  std::array<int, 20> counts{};
  for (std::uint64_t id = 0; id < count; ++id) {
    scenes::Random random(1, id);
    const double first = random.uniform();
    const double second = random.uniform();
    ASSERT_TRUE(first >= 0 && first < 1 && second >= 0 && second < 1);
    ++counts[static_cast<std::size_t>(10 * first)];
    ++counts[10 + static_cast<std::size_t>(10 * second)];
  }
  // Each is binomial with 2000 expected and a standard deviation of 42.
  for (const int each : counts) EXPECT_NEAR(each, count / 10, 5 * 42.5);
}

/// The mean over the pixel, from a grid of points.
std::array<double, 3> supersampled(const scenes::Scene& scene, long i, long j, int side) {
  std::array<double, 3> mean{};
  for (int k = 0; k < side * side; ++k) {
    const double x = static_cast<double>(i) + (k % side + 0.5) / side;
    const double y = static_cast<double>(j) + (k / side + 0.5) / side;
    const Color rgb = radiance(scene, x, y);
    for (std::size_t c = 0; c < 3; ++c) mean[c] += double{rgb[c]} / (side * side);
  }
  return mean;
}

struct AverageCase {
  std::string_view name;
  int width, height;
  /// Of the grid of points: a straight edge or a small disc passes through less than 2 side of its
  /// side^2 cells, and is wrong by about half of each, at random.
  int side;
  double tolerance;
};

TEST(PixelAverage, AgreesWithSupersampling) {
  // The gradient in few pixels, so that their means differ from the values at their centres.
  for (const auto& [name, width, height, side, tolerance] :
       {AverageCase{"edge", 40, 24, 100, 0.01}, AverageCase{"corner", 40, 24, 100, 0.01},
        AverageCase{"dot", 40, 24, 100, 0.01 * 2.82}, AverageCase{"dot", 5, 3, 100, 0.01 * 2.82},
        AverageCase{"gradient", 5, 4, 100, 2e-5}}) {
    const auto scene = make(name, width, height);
    std::size_t partial = 0;
    for (long j = 0; j < height; ++j) {
      for (long i = 0; i < width; ++i) {
        Color exact{};
        ASSERT_TRUE(scene->pixel_average(i, j, exact)) << name;
        const auto brute = supersampled(*scene, i, j, side);
        const Color center =
            radiance(*scene, static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(exact[c], brute[c], tolerance) << name << ' ' << i << ", " << j;
          if (std::abs(exact[c] - center[c]) > 10 * tolerance) ++partial;
        }
      }
    }
    EXPECT_GT(partial, 0u) << name << ": one sample would have done";
  }
}

TEST(PixelAverage, IsLeftAloneWhereItIsUnknown) {
  for (const std::string_view name : {"fan", "chess", "star", "checker", "dof"}) {
    Color rgb{7, 8, 9};
    EXPECT_FALSE(make(name, 32, 32)->pixel_average(3, 4, rgb)) << name;
    EXPECT_EQ(rgb, (Color{7, 8, 9})) << name;
  }
}

std::array<double, 3> total(const scenes::Scene& scene, int width, int height) {
  std::array<double, 3> sum{};
  for (long j = 0; j < height; ++j) {
    for (long i = 0; i < width; ++i) {
      Color rgb{};
      EXPECT_TRUE(scene.pixel_average(i, j, rgb));
      for (std::size_t c = 0; c < 3; ++c) sum[c] += double{rgb[c]};
    }
  }
  return sum;
}

TEST(PixelAverage, AddsUpToTheKnownTotal) {
  constexpr double pi = std::numbers::pi;
  EXPECT_NEAR(total(*make("edge", 100, 70), 100, 70)[0], 0.57 * 100 * 70, 1e-3);
  const auto corner = total(*make("corner", 90, 50), 90, 50);
  for (std::size_t c = 0; c < 3; ++c) {
    const double light = radiance(*make("corner", 90, 50), 89.9, 49.9)[c];
    EXPECT_NEAR(corner[c], light * pi * 36 / 4, 1e-3);
  }
  const double dots = 49 * pi * 0.09 * (3 - 0.18);
  EXPECT_NEAR(total(*make("dot", 64, 100), 64, 100)[1], 0.18 * 64 * 100 + dots, 1e-3);
}

TEST(Area, OfHalfPlanes) {
  EXPECT_NEAR(scenes::half_plane_area(1, 1, 1), 0.5, 1e-15);
  EXPECT_NEAR(scenes::half_plane_area(1, 1, 0.5), 0.125, 1e-15);
  EXPECT_NEAR(scenes::half_plane_area(2, 1, 1), 0.25, 1e-15);
  EXPECT_NEAR(scenes::half_plane_area(-2, 1, 0), 0.75, 1e-15);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const double a = uniform(random), b = uniform(random), c = 2 * uniform(random);
    if (std::abs(a * b) < 1e-3) continue;
    const double area = scenes::half_plane_area(a, b, c);
    // The other side, mirror images, and the same square cut in its diagonal's terms.
    EXPECT_NEAR(area + scenes::half_plane_area(-a, -b, -c), 1, 1e-12);
    EXPECT_NEAR(area, scenes::half_plane_area(b, a, c), 1e-12);
    EXPECT_NEAR(area, scenes::half_plane_area(-a, b, c - a), 1e-12);
  }
}

TEST(Area, OfDiscsAddsUp) {
  EXPECT_EQ(scenes::disc_area(-0.5, -0.5, 1), 1);
  EXPECT_EQ(scenes::disc_area(1, 1, 1.4), 0);
  EXPECT_NEAR(scenes::disc_area(0, 0, 1), std::numbers::pi / 4, 1e-15);
  EXPECT_NEAR(scenes::disc_area(-0.2, -0.7, 0.1), std::numbers::pi * 0.01, 1e-15);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 200; ++i) {
    const double x = uniform(random), y = uniform(random), radius = 5 * uniform(random);
    double sum = 0;
    for (int j = -7; j < 7; ++j) {
      for (int k = -7; k < 7; ++k) sum += scenes::disc_area(j + x, k + y, radius);
    }
    EXPECT_NEAR(sum, std::numbers::pi * radius * radius, 1e-12);
  }
}

TEST(Scenes, FanIsBlackAndWhiteAndMirrorsLeftToRight) {
  const auto scene = scenes::make_scene({.name = "fan", .width = 512, .height = 512});
  std::size_t black = 0;
  for (int i = 0; i < 512; ++i) {
    const double x = i + 0.3;
    const double y = 100.7;
    const auto left = radiance(*scene, x, y);
    EXPECT_TRUE(left[0] == 0 || left[0] == 1);
    EXPECT_EQ(left, radiance(*scene, 512 - x, y)) << x;
    if (left[0] == 0) ++black;
  }
  EXPECT_GT(black, 100u);
  EXPECT_LT(black, 300u);
}

TEST(Scenes, ZonePlateReachesItsFrequencyAtTheFarCorner) {
  // Crossings of the mean over the last 40 pixels of the diagonal: two per cycle.
  const auto crossings = [](const scenes::Scene& scene) {
    int count = 0;
    bool above = false;
    for (int i = 0; i <= 4000; ++i) {
      const double along = (724 - 40 + i * 0.01) / std::numbers::sqrt2;
      const bool now = radiance(scene, along, along)[0] > 0.5f;
      if (i > 0 && now != above) ++count;
      above = now;
    }
    return count;
  };
  const auto expected = [](double frequency) { return 2 * 40 * frequency * (724 - 20) / 724; };
  EXPECT_NEAR(crossings(*make("zoneplate", 512, 512)), expected(0.4), 1);
  EXPECT_NEAR(crossings(*make("zoneplate-high", 512, 512)), expected(0.8), 1);
  scenes::SceneOptions options{.name = "zoneplate", .zone_frequency = 0.2};
  EXPECT_NEAR(crossings(*scenes::make_scene(options)), expected(0.2), 1);
  options.name = "zoneplate-high";
  EXPECT_NEAR(crossings(*scenes::make_scene(options)), expected(0.8), 1) << "has its own";
}

// Each edge of a spoke is a ray from the star's centre: it meets a circle about it just once.
TEST(Scenes, StarHas37Spokes) {
  const auto scene = make("star", 400, 400);
  for (const double radius : {30, 120, 170}) {
    int changes = 0;
    float before = -1;
    for (int i = 0; i <= 7200; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / 7200;
      const float now =
          radiance(*scene, 200 + radius * std::cos(angle), 200 + radius * std::sin(angle))[0];
      if (before >= 0 && now != before) ++changes;
      before = now;
    }
    EXPECT_EQ(changes, 74) << radius;
  }
  EXPECT_EQ(radiance(*scene, 3, 3)[0], 1);
}

TEST(Scenes, EdgeLeansByFiveDegrees) {
  const auto scene = make("edge", 300, 200);
  const auto black_until = [&](double y) {
    double x = 0;
    while (radiance(*scene, x, y)[0] == 0) x += 0.01;
    return x;
  };
  const double angle = std::atan2(black_until(0) - black_until(200), 200);
  EXPECT_NEAR(angle * 180 / std::numbers::pi, 5, 0.01);
}

// In points on a grid, not by the closed form, which may share its mistakes.
TEST(Scenes, DotsHaveTheEnergyOfTheirArea) {
  const auto scene = make("dot", 128, 96);
  constexpr int side = 12;
  int bright = 0;
  for (int i = 0; i < 128 * side; ++i) {
    for (int j = 0; j < 96 * side; ++j) {
      const float value = radiance(*scene, (i + 0.5) / side, (j + 0.5) / side)[0];
      if (value == 3.0f) {
        ++bright;
      } else {
        ASSERT_EQ(value, 0.18f);
      }
    }
  }
  const double area = 49 * std::numbers::pi * 0.09;
  EXPECT_NEAR(bright / double{side * side}, area, 0.03 * area);
}

TEST(Scenes, CheckerHasTwoColoursBelowTheHorizonOnly) {
  const auto scene = make("checker", 200, 200);
  const auto colors_between = [&](int top, int bottom) {
    std::set<Color> colors;
    for (int y = top; y < bottom; ++y) {
      for (int x = 0; x < 200; ++x) colors.insert(radiance(*scene, x + 0.5, y + 0.5));
    }
    return colors.size();
  };
  EXPECT_GT(colors_between(0, 50), 100u);
  EXPECT_EQ(colors_between(100, 200), 2u);
}

TEST(Scenes, SunIsSmallAndAThousandTimesAsBrightAsTheSky) {
  const auto scene = make("sun", 200, 200);
  int sun = 0, sky = 0, dark = 0;
  for (int i = 0; i < 200 * 200; ++i) {
    const float value = radiance(*scene, i % 200 + 0.5, i / 200 + 0.5)[0];
    if (value == 1000) {
      ++sun;
    } else if (value < 0.02f) {
      ++dark;
    } else {
      EXPECT_LT(value, 4);
      ++sky;
    }
  }
  EXPECT_GT(sun, 40);
  EXPECT_LT(sun, 400);
  EXPECT_GT(dark, 5000);
  EXPECT_GT(sky, 20000);
}

TEST(Scenes, AreAllListed) {
  const auto names = scenes::scene_names();
  const std::set<std::string_view> listed(names.begin(), names.end());
  EXPECT_EQ(listed.size(), names.size());
  EXPECT_EQ(listed, (std::set<std::string_view>{"fan", "chess", "zoneplate", "zoneplate-high",
                                                "star", "edge", "checker", "gradient", "dot",
                                                "corner", "sun", "softshadow", "dof", "glossy"}));
  for (const std::string_view name : names) {
    EXPECT_NE(scenes::scene_list().find(name), std::string::npos);
  }
}

TEST(Scenes, RefuseWhatTheyCannotMake) {
  try {
    (void)make("cheese", 8, 8);
    FAIL() << "a cheese";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'cheese'"), std::string::npos) << text;
    EXPECT_NE(text.find(scenes::scene_list()), std::string::npos) << text;
  }
  EXPECT_THROW((void)scenes::make_scene({.name = "image:"}), std::invalid_argument);
  for (const std::string_view name : scenes::scene_names()) {
    EXPECT_THROW((void)make(name, 0, 8), std::invalid_argument);
    EXPECT_THROW((void)make(name, 8, -1), std::invalid_argument);
  }
  EXPECT_THROW((void)scenes::make_scene({.name = "image:/nowhere/at/all.png"}), std::runtime_error);
}

}  // namespace
