// Fits return the law that made the points, and errors that its scatter deserves.
#include "studies/transport_fits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace bedload {
namespace {

TEST(FluxLaw, ReturnsTheLawThatMadeThePoints) {
  const std::vector<double> theta{0.15, 0.18, 0.25, 0.3};
  for (const double exponent : {1.5, 3.0}) {
    std::vector<double> q;
    for (const double t : theta) q.push_back(7 * std::pow(t - 0.12, exponent));
    const auto law = fit_flux_law(theta, q, exponent);
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->threshold, 0.12, 1e-12);
    EXPECT_NEAR(law->coefficient, 7, 1e-9);
    EXPECT_LT(law->threshold_error, 1e-6);
  }
}

TEST(FluxLaw, NeedsThreePointsAndAFluxThatRises) {
  const std::vector<double> two{0.1, 0.2}, three{0.1, 0.2, 0.3}, falling{3, 2, 1};
  EXPECT_FALSE(fit_flux_law(two, two, 1.5));
  EXPECT_FALSE(fit_flux_law(three, falling, 1.5));
}

TEST(FluxLaw, StatesTheScatterOfRepeatedFits) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.01);
  double mean = 0, squares = 0, stated = 0;
  constexpr int repeats = 4000;
  for (int n = 0; n < repeats; ++n) {
    std::vector<double> theta, q;
    for (int k = 0; k < 12; ++k) {
      theta.push_back(0.15 + 0.02 * k);
      q.push_back(std::pow(2 * (theta.back() - 0.1) + noise(random), 3));
    }
    const auto law = fit_flux_law(theta, q, 3);
    mean += law->threshold / repeats, squares += law->threshold * law->threshold / repeats;
    stated += law->threshold_error * law->threshold_error / repeats;
  }
  EXPECT_NEAR(mean, 0.1, 1e-3);
  EXPECT_NEAR(std::sqrt(stated), std::sqrt(squares - mean * mean), 0.05 * std::sqrt(stated));
}

TEST(Decay, ReturnsTheTimeThatMadeTheSamples) {
  std::vector<double> time, y;
  double began = 0;
  for (int n = 1; n <= 25; ++n) {   // windows of 0.1 and 0.2 by turns
    time.push_back(began + (n % 2 ? 0.1 : 0.2));
    constexpr int parts = 1000;
    double mean = 0;
    for (int k = 0; k < parts; ++k)
      mean += (5 + 30 * std::exp(-(began + (k + 0.5) / parts * (time.back() - began)) / 0.7)) / parts;
    y.push_back(mean), began = time.back();
  }
  const auto decay = fit_decay(time, y);
  ASSERT_TRUE(decay);
  EXPECT_NEAR(decay->time, 0.7, 1e-6);
  EXPECT_NEAR(decay->first, 35, 1e-4);
  EXPECT_NEAR(decay->last, 5, 1e-4);
}

TEST(Decay, StatesTheScatterOfRepeatedFits) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.3);
  double mean = 0, squares = 0, stated = 0;
  constexpr int repeats = 400;
  for (int n = 0; n < repeats; ++n) {
    std::vector<double> time, y;
    for (int k = 1; k <= 50; ++k) time.push_back(k), y.push_back(5 + 30 * std::exp(-k / 8.0) + noise(random));
    const auto decay = fit_decay(time, y);
    ASSERT_TRUE(decay);
    mean += decay->time / repeats, squares += decay->time * decay->time / repeats;
    stated += decay->time_error * decay->time_error / repeats;
  }
  EXPECT_NEAR(mean, 8, 0.1);
  EXPECT_NEAR(std::sqrt(stated), std::sqrt(squares - mean * mean), 0.15 * std::sqrt(stated));
}

TEST(Decay, IsNotKnownWhereMotionGrowsOrStaysOrIsTooShort) {
  std::vector<double> time, growing, steady, straight;
  for (int n = 1; n <= 20; ++n) {
    time.push_back(n), growing.push_back(10 - 9 * std::exp(-n / 4.0)), steady.push_back(3), straight.push_back(40 - n);
  }
  EXPECT_FALSE(fit_decay(time, growing));
  EXPECT_FALSE(fit_decay(time, steady));
  EXPECT_FALSE(fit_decay(time, straight));   // slower than the samples last
  EXPECT_FALSE(fit_decay(std::span(time).first(5), std::span(growing).first(5)));
}

}   // namespace
}   // namespace bedload
