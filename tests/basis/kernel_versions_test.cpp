// SPDX-License-Identifier: MIT
// Every version of the kernels that this processor can run gives the same bits.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "freqsynth/basis/kernels.h"
#include "support/kernel_cases.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using namespace kernel_cases;

template <class T>
bool same_bits(const AlignedVector<T>& a, const AlignedVector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

class KernelVersion : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    version_ = find(GetParam());
    if (version_ == nullptr) {
      GTEST_SKIP() << "this processor, or this build, has no " << GetParam();
    }
  }

  const Kernels* version_ = nullptr;
};

INSTANTIATE_TEST_SUITE_P(Kernels, KernelVersion, testing::Values("plain", "avx2", "avx512"),
                         [](const auto& version) { return std::string(version.param); });

TEST_P(KernelVersion, GivesTheBitsOfThePlainOne) {
  for_all_absorptions([&](auto make) {
    const auto expected = make();
    const auto actual = make();
    expected->run(plain());
    actual->run(*version_);
    EXPECT_TRUE(same_bits(actual->states, expected->states));
    EXPECT_TRUE(same_bits(actual->sums, expected->sums));
    EXPECT_TRUE(same_bits(actual->residuals, expected->residuals));
    EXPECT_EQ(actual->change, expected->change);
  });
  for_all_updates([&](auto make) {
    Update expected = make();
    Update actual = make();
    expected.run(plain());
    actual.run(*version_);
    EXPECT_TRUE(same_bits(actual.inverse, expected.inverse));
    EXPECT_TRUE(same_bits(actual.normal, expected.normal));
  });
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    EXPECT_TRUE(same_bits(outer_product(*version_, terms), outer_product(plain(), terms)));
    EXPECT_TRUE(same_bits(Product(*version_, terms).out, Product(plain(), terms).out));
  }
  for (unsigned seed = 0; seed < 200; ++seed) {
    Residuals expected(seed), actual(seed);
    expected.run(plain());
    actual.run(*version_);
    EXPECT_TRUE(same_bits(actual.out, expected.out));
  }
  for_all_sizes([&](std::size_t columns, std::size_t rows) {
    Separable expected(columns, rows), actual(columns, rows);
    expected.run(plain());
    actual.run(*version_);
    EXPECT_TRUE(same_bits(actual.out, expected.out));
  });
}

TEST_P(KernelVersion, RoundsProductsBeforeItAddsThem) {
  // -p + a b is 0 where p is the rounded product, and its rounding error if they are fused. The
  // volatile copy keeps this file's own compiler from fusing.
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    oracle::Random random(static_cast<unsigned>(terms));
    Update update(terms, terms, random);
    AlignedVector<double> outer(max_terms * max_terms);
    AlignedVector<double> x = padded_numbers(terms, random);
    for (std::size_t i = 0; i < terms; ++i) {
      for (std::size_t j = 0; j < terms; ++j) {
        volatile double product = update.a[i] * update.a[j];
        update.normal[i * max_terms + j] = -product;
        volatile double factor = x[i] * 0.7;
        product = factor * x[j];
        outer[i * max_terms + j] = -product;
      }
    }
    update.run(*version_);
    version_->add_outer_product(outer.data(), x.data(), 0.7, terms);
    for (std::size_t i = 0; i < terms; ++i) {
      for (std::size_t j = 0; j < terms; ++j) {
        EXPECT_EQ(update.normal[i * max_terms + j], 0);
        EXPECT_EQ(outer[i * max_terms + j], 0);
      }
    }

    Absorption block(terms, 1, false, true, random);
    for (std::size_t i = 0; i < max_terms; ++i) {
      volatile float product = block.values[0] * block.row.gain[i];
      block.states[i] = i < terms ? 0 : -product;
    }
    block.run(*version_);
    for (std::size_t i = terms; i < max_terms; ++i) EXPECT_EQ(block.states[i], 0);
  }
}

TEST(KernelVersions, TheBestThatTheProcessorRunsIsCalled) {
  const auto runnable = detail::runnable_kernels();
  ASSERT_FALSE(runnable.empty());
  EXPECT_STREQ(runnable.front()->name, "plain");
  std::vector<std::string> names;
  for (const Kernels* kernels : runnable) names.emplace_back(kernels->name);
  const std::vector<std::string> all = {"plain", "avx2", "avx512"};
  EXPECT_EQ(names,
            std::vector(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(names.size())));
#if defined(__x86_64__) && !defined(_WIN32)
  EXPECT_EQ(names.size() > 1, __builtin_cpu_supports("avx2") != 0);
#endif

  oracle::Random random(1);
  Update expected(20, 64, random);
  Update actual = expected;
  expected.run(*runnable.back());
  detail::rank_one_update(actual.inverse.data(), actual.normal.data(), actual.a.data(), 20, 64);
  EXPECT_TRUE(same_bits(actual.inverse, expected.inverse));
  EXPECT_EQ(&detail::chosen_kernels(), runnable.back());
}

}  // namespace
}  // namespace freqsynth
