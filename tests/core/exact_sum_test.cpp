#include "core/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace volgi::test {
namespace {

std::vector<double> numbers_of_all_sizes(size_t count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-300, 300);
  std::vector<double> numbers(count);
  for (double& x : numbers) x = std::ldexp(mantissa(random), exponent(random));
  return numbers;
}

TEST(ExactSum, NoOrderMatters) {
  std::vector<double> numbers = numbers_of_all_sizes(5000);
  ExactSum once;
  for (const double x : numbers) once.add(x);
  std::mt19937 random(3);
  for (int k = 0; k < 5; ++k) {
    std::shuffle(numbers.begin(), numbers.end(), random);
    std::array<ExactSum, 7> parts;
    for (size_t i = 0; i < numbers.size(); ++i) parts[i * i % 7].add(numbers[i]);
    ExactSum all;
    for (const ExactSum& p : parts) all.add(p);
    EXPECT_EQ(all.value(), once.value());
  }
}

// What cancels leaves nothing behind, at any size.
TEST(ExactSum, LosesNothing) {
  for (const double large : {1e300, 1.0, 1e-300}) {
    ExactSum sum;
    sum.add(large);
    sum.add(5e-324);
    sum.add(-large);
    EXPECT_EQ(sum.value(), 5e-324);
    sum.add(-1e-323);
    EXPECT_EQ(sum.value(), -5e-324);
  }
  ExactSum quarters;
  for (int i = 0; i < 1000; ++i) quarters.add(-0.25);
  EXPECT_EQ(quarters.value(), -250.0);
  EXPECT_EQ(ExactSum().value(), 0.0);
}

TEST(ExactSum, AsGoodAsLongDoubles) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  ExactSum sum;
  long double expected = 0.0L;
  for (int i = 0; i < 100000; ++i) {
    const double x = uniform(random);
    sum.add(x);
    expected += static_cast<long double>(x);
  }
  EXPECT_NEAR(sum.value(), double(expected), 1e-13);
}

TEST(ExactSum, SaysWhatIsNotFinite) {
  ExactSum sum;
  sum.add(1.0);
  sum.add(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(sum.value()));
}

}  // namespace
}  // namespace volgi::test
