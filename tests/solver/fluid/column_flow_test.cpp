// The column against closed forms: Couette, film, Brinkman, log law; its books, its order, its extremes.
#include "solver/fluid/column_flow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "solver/fluid/wall_law.hpp"

namespace bedload {
namespace {

constexpr double forever = 1e12;   // a step after which any flow is steady [s]

/// A column with its flow and the grains that it sees, at first none.
struct TestColumn {
  explicit TestColumn(const Column& given) : column(given), flow(given), u(layers()), solid{u, u}, exchange{u, u} {}
  std::size_t layers() const { return static_cast<std::size_t>(column.layers); }
  double middle(std::size_t k) const { return (double(k) + 0.5) * column.thickness; }
  double height() const { return column.layers * column.thickness; }
  void step(double dt, int count = 1) {
    for (int n = 0; n < count; ++n) flow.step(u, solid, exchange, drive, dt);
  }
  double unbalanced() const {
    const ColumnBooks& b = flow.books();
    return b.gained - (b.driving - b.on_bottom - b.on_lid - b.on_grains);
  }

  Column column;
  ColumnFlow flow;
  std::vector<double> u;
  SolidLayers solid;
  LayerExchange exchange;
  ColumnDrive drive;
};

/// u/U of a fluid at rest whose lid begins to move: y - sum 2 (-1)^(n+1)/(n pi) sin(n pi y) exp(-n^2 pi^2 nu t/H^2).
double couette_start(double y, double time) {
  double u = y;
  for (int n = 1; n < 60; ++n) {
    const double wave = n * std::numbers::pi;
    u -= 2 * (n % 2 ? 1 : -1) / wave * std::sin(wave * y) * std::exp(-wave * wave * time);
  }
  return u;
}

double largest_error_of_start(int layers, int steps) {
  const double time = 0.1;
  TestColumn c({.layers = layers, .thickness = 1.0 / layers, .viscosity = 1});
  c.drive.lid_speed = 1;
  c.step(time / steps, steps);
  double error = 0;
  for (std::size_t k = 0; k < c.layers(); ++k)
    error = std::max(error, std::abs(c.u[k] - couette_start(c.middle(k), time)));
  return error;
}

TEST(ColumnFlow, StartsAsCouetteFlowDoes) {
  EXPECT_NEAR(couette_start(0.5, 0.1), 0.26276, 1e-5);   // of a published table
  const double coarse = largest_error_of_start(16, 1000), fine = largest_error_of_start(32, 4000);
  EXPECT_LT(fine, 5e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);   // second order in the layer with dt ~ h^2
  const double long_steps = largest_error_of_start(256, 20), short_steps = largest_error_of_start(256, 40);
  EXPECT_NEAR(std::log2(long_steps / short_steps), 1, 0.15);   // first in time
}

TEST(ColumnFlow, UnderALidIsALineToRounding) {
  for (const int layers : {1, 2, 7, 300}) {
    TestColumn c({.layers = layers, .thickness = 2.0 / layers, .viscosity = 3e-6});
    c.drive.lid_speed = -0.7;
    c.step(forever, 3);
    for (std::size_t k = 0; k < c.layers(); ++k) EXPECT_NEAR(c.u[k], -0.7 * c.middle(k) / 2, 1e-13);
    EXPECT_NEAR(c.flow.books().on_bottom, -3e-6 * 0.7 / 2, 1e-18);
  }
}

/// Grains that do not turn resist as C/4 more viscosity would; a torque of their own stirs nothing where all of them have it.
TEST(ColumnFlow, BearsUniformCouplesAsAStressEverywhere) {
  const double nu = 3e-6, rate = 4e-6, pull = 2e-6, height = 2, lid = 0.7;
  for (const int layers : {1, 2, 7, 300}) {
    TestColumn c({.layers = layers, .thickness = height / layers, .viscosity = nu});
    c.drive.lid_speed = lid;
    c.exchange.turn_rate.assign(c.layers(), rate), c.exchange.turn_pull.assign(c.layers(), pull);
    c.step(forever, 3);
    for (std::size_t k = 0; k < c.layers(); ++k) EXPECT_NEAR(c.u[k], lid * c.middle(k) / height, 1e-13);
    const double stress = (nu + rate / 4) * lid / height - pull / 2;
    for (const double each : c.flow.stress()) EXPECT_NEAR(each, stress, 1e-18);
    EXPECT_NEAR(c.flow.books().on_lid, -stress, 1e-18);
  }
}

/// A torque of the grains works on what they read of the flow's turning, half of find_shear(), and resistance to it takes work.
TEST(ColumnFlow, GainsByCouplesThePowerThatTheGrainsSpend) {
  const double h = 1e-4, dt = 1e-3;
  for (const Top top : {Top::lid, Top::free_slip})
    for (const bool resist : {false, true}) {
      TestColumn c({.layers = 40, .thickness = h, .viscosity = 1e-30, .top = top});
      std::mt19937 bits(3);
      std::uniform_real_distribution<double> any(0, 1);
      c.exchange.turn_rate.assign(40, 0), c.exchange.turn_pull.assign(40, 0);
      for (double& u : c.u) u = any(bits);
      for (double& each : resist ? c.exchange.turn_rate : c.exchange.turn_pull) each = 1e-6 * any(bits);
      const std::vector<double> start = c.u;
      std::vector<double> shear;
      c.flow.find_shear(start, 0, shear);
      c.step(dt);
      double gained = 0, spent = 0;
      for (std::size_t k = 0; k < 40; ++k)
        gained += start[k] * (c.u[k] - start[k]) / dt, spent += 0.5 * c.exchange.turn_pull[k] * shear[k];
      if (resist) EXPECT_LT(gained, 0);
      else EXPECT_NEAR(gained / spent, 1, 1e-9);
      EXPECT_NEAR(c.unbalanced(), 0, 1e-12 * std::abs(c.flow.books().on_bottom));
    }
}

TEST(ColumnFlow, OfAFilmIsTheParabolaAndWhatHalfALayerAtTheWallAdds) {
  const double nu = 2e-6, a = 0.01, height = 0.02;
  for (const int layers : {5, 40}) {
    const double h = height / layers;
    TestColumn c({.layers = layers, .thickness = h, .viscosity = nu, .top = Top::free_slip});
    c.drive.acceleration = a;
    c.step(forever, 3);
    for (std::size_t k = 0; k < c.layers(); ++k) {
      const double z = c.middle(k), parabola = a / nu * z * (height - z / 2);
      EXPECT_NEAR(c.u[k] / (parabola + a * h * h / (8 * nu)), 1, 1e-11);
    }
    EXPECT_NEAR(c.flow.books().on_bottom, a * height, 1e-15);   // the weight of the film
    EXPECT_EQ(c.flow.books().on_lid, 0);
  }
}

/// Over a fixed bed of uniform phi, under a lid or in a film that runs down: the flux eps u obeys
/// nu eps^2 (eps u)'' = rate (eps u) - eps^2 a in the bed, nu (eps u)'' = -a above, with its gradient the same on both sides.
double largest_error_of_brinkman(int layers_per_depth, Top top) {
  const double nu = 1e-6, phi = 0.6, eps = 1 - phi, rate = 500, depth = eps * std::sqrt(nu / rate);
  const double h = depth / layers_per_depth, bed = 10 * depth, gap = 20 * depth;
  TestColumn c({.layers = 30 * layers_per_depth, .thickness = h, .viscosity = nu, .top = top});
  for (std::size_t k = 0; k < c.layers(); ++k)
    if (c.middle(k) < bed) c.solid.fraction[k] = phi, c.exchange.rate[k] = rate;
  double a = 0, gradient = 0;   // of the flux at the surface
  if (top == Top::lid) {
    c.drive.lid_speed = 1;
    gradient = 1 / (gap + depth * std::tanh(bed / depth));
  } else {
    c.drive.acceleration = a = 1;
    gradient = a * gap / nu;
  }
  c.step(forever, 3);
  const double deep = eps * eps * a / rate;   // the flux far from bottom and surface
  const double rising = (gradient * depth + deep * std::sinh(bed / depth)) / std::cosh(bed / depth);
  const auto in_bed = [&](double z) { return deep * (1 - std::cosh(z / depth)) + rising * std::sinh(z / depth); };
  double error = 0;
  for (std::size_t k = 0; k < c.layers(); ++k) {
    const double z = c.middle(k), y = z - bed;
    const double u = y < 0 ? in_bed(z) / eps : in_bed(bed) + gradient * y - a / nu * y * y / 2;
    error = std::max(error, std::abs(c.u[k] - u) / in_bed(bed));
  }
  return error;
}

TEST(ColumnFlow, DecaysInAPorousBedAsBrinkmanSaysAtSecondOrder) {
  for (const Top top : {Top::lid, Top::free_slip}) {
    const double coarse = largest_error_of_brinkman(10, top), fine = largest_error_of_brinkman(20, top);
    EXPECT_LT(fine, 2e-3);
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.15);
  }
}

TEST(ColumnFlow, ThroughAUniformBedDecaysExactlyLikeTheDiscreteExponential) {
  // q + 1/q - 2 = (h/depth)^2 for the ratio q of neighbours, whatever the layers resolve.
  const double nu = 1e-6, eps = 0.4, rate = 500, h = 1e-5;
  TestColumn c({.layers = 60, .thickness = h, .viscosity = nu});
  std::fill(c.solid.fraction.begin(), c.solid.fraction.end(), 1 - eps);
  std::fill(c.exchange.rate.begin(), c.exchange.rate.end(), rate);
  c.drive.lid_speed = 1;
  c.step(forever, 3);
  const double half = 0.5 * h * h * rate / (nu * eps * eps), q = 1 + half + std::sqrt(half * (half + 2));
  EXPECT_NEAR(c.u[50] / c.u[49], q, 1e-10 * q);
}

/// A bed of phi that falls smoothly from `packed` to nothing about z_b.
void add_bed(TestColumn& c, double packed, double z_b, double width, double rate) {
  for (std::size_t k = 0; k < c.layers(); ++k) {
    const double part = 0.5 * (1 - std::tanh((c.middle(k) - z_b) / width));
    c.solid.fraction[k] = packed * part, c.exchange.rate[k] = rate * part;
  }
}

TEST(ColumnFlow, PutsTheWeightOfAllFluidOnBedAndBottom) {   // rho_f g sin(alpha) int eps dz
  for (const double packing : {0.0, 0.6}) {
    TestColumn c({.layers = 200, .thickness = 1e-4, .viscosity = 1e-6, .top = Top::free_slip, .packing = packing});
    add_bed(c, 0.6, 0.008, 5e-4, 3e3);
    c.drive.acceleration = 0.05;
    c.step(10, 400);
    double fluid = 0;
    for (const double phi : c.solid.fraction) fluid += (1 - phi) * c.column.thickness;
    const ColumnBooks& b = c.flow.books();
    EXPECT_NEAR(b.on_bottom + b.on_grains, 0.05 * fluid, 1e-11 * 0.05 * fluid);
    EXPECT_LT(std::abs(b.on_bottom), 1e-2 * b.on_grains);
  }
}

TEST(ColumnFlow, OverARoughBottomHasTheSlopeOfALogLaw) {
  const double a = 0.02, nu = 1e-12, h = 1e-3, roughness = 3e-3, z0 = roughness / 30;
  TestColumn c({.layers = 100,
                .thickness = h,
                .viscosity = nu,
                .top = Top::free_slip,
                .packing = 0.6,
                .sand_roughness = roughness});
  c.drive.acceleration = a;
  c.step(1e4, 200);
  const double height = c.height(), friction_speed = std::sqrt(a * height);
  EXPECT_NEAR(c.flow.books().on_bottom, a * height, 1e-10 * a * height);
  for (std::size_t k = 1; k < c.layers(); ++k) {   // tau falls to zero at the free surface
    const double share = std::sqrt(1 - double(k) * h / height);
    const double slope = (c.u[k] - c.u[k - 1]) / std::log((c.middle(k) + z0) / (c.middle(k - 1) + z0));
    EXPECT_NEAR(slope / (friction_speed * share / von_karman), 1, 1e-6) << k;
  }
  const double bottom = friction_speed / von_karman * std::log1p(0.5 * h / z0);
  EXPECT_NEAR(c.u[0] / bottom, 1, 1e-9);
}

TEST(ColumnFlow, AboveAPackedBedIsLogarithmicFromWhereItsMixingLengthIsZero) {
  const double phi_max = 0.6, lid_stress_drop = 0.02, h = 1e-4, z_b = 0.01;
  TestColumn c({.layers = 1000, .thickness = h, .viscosity = 1e-9, .top = Top::free_slip, .packing = phi_max});
  add_bed(c, 0.61, z_b, 3e-4, 1e3);
  c.drive.acceleration = lid_stress_drop;
  c.step(1e3, 300);
  // By hand: l = kappa int (phi_max - phi)/phi_max above the highest packed layer.
  double origin = 0;
  for (std::size_t k = c.layers(); k-- > 0 && origin == 0;)
    if (c.solid.fraction[k] >= phi_max) origin = double(k + 1) * h;
  double lost = 0;
  for (std::size_t k = 0; k < c.layers(); ++k)
    if (c.middle(k) > origin) lost += c.solid.fraction[k] / phi_max * h;
  for (const std::size_t k : {200u, 400u, 800u}) {   // clear of grains: l = kappa (z - origin - lost)
    const double below = c.middle(k - 1) - origin - lost, above = c.middle(k) - origin - lost;
    const double stress = lid_stress_drop * (c.height() - double(k) * h);
    const double slope = (c.u[k] - c.u[k - 1]) / std::log(above / below);
    EXPECT_NEAR(slope / (std::sqrt(stress) / von_karman), 1, 1e-4) << k;
  }
  const double deep = c.u[std::size_t(z_b / h) / 2];   // no eddies there: what the drive pushes through the bed
  EXPECT_NEAR(deep / (lid_stress_drop * (1 - 0.61) / 1e3), 1, 1e-3);
}

TEST(ColumnFlow, GivesEddiesTheMixingLengthThatGrainsLeaveThem) {   // eps l^2 S^2 = the weight of the fluid above
  const double a = 0.05, phi_max = 0.6, h = 1e-3, roughness = 6e-3;
  TestColumn c({.layers = 30,
                .thickness = h,
                .viscosity = 1e-18,
                .top = Top::free_slip,
                .packing = phi_max,
                .sand_roughness = roughness});
  c.drive.acceleration = a;
  for (std::size_t k = 0; k < c.layers(); ++k) c.solid.fraction[k] = 0.25 * (1 + std::sin(1.3 * double(k)));
  c.step(1e4, 200);
  const int points = 4000;      // of the midpoint rule, per half layer
  std::vector<double> halves;   // integrals of dz/l, half layer by half layer
  double length = von_karman * roughness / 30;
  for (std::size_t k = 0; k < c.layers(); ++k) {
    const double slope = von_karman * (1 - c.solid.fraction[k] / phi_max), way = 0.5 * h / points;
    for (int half = 0; half < 2; ++half) {
      halves.push_back(0);
      for (int n = 0; n < points; ++n) halves.back() += way / (length + (n + 0.5) * way * slope);
      length += 0.5 * h * slope;
    }
  }
  for (std::size_t e = 1; e < c.layers(); ++e) {
    double weight = 0;
    for (std::size_t k = e; k < c.layers(); ++k) weight += a * h * (1 - c.solid.fraction[k]);
    const double eps = 1 - 0.5 * (c.solid.fraction[e - 1] + c.solid.fraction[e]);
    const double slip = std::sqrt(weight / eps) * (halves[2 * e - 1] + halves[2 * e]);
    EXPECT_NEAR((c.u[e] - c.u[e - 1]) / slip, 1, 1e-4) << e;
    EXPECT_NEAR(c.flow.stress()[e], weight, 1e-10 * weight) << e;
  }
}

TEST(ColumnFlow, HasALogLayerUnderALidToo) {
  TestColumn c({.layers = 200, .thickness = 1e-3, .viscosity = 1e-9, .packing = 0.6, .sand_roughness = 1e-3});
  c.drive.lid_speed = 1;
  c.step(1e3, 300);
  const double friction_speed = std::sqrt(-c.flow.books().on_lid);
  for (std::size_t e = 180; e < 198; ++e) {   // the bottom bounds eddies too: 1/l^2 = (1/z^2 + 1/y^2)/kappa^2
    const double y = c.height() - double(e) * c.column.thickness, z = double(e) * c.column.thickness;
    const double below = c.height() - c.middle(e - 1), above = c.height() - c.middle(e);
    const double slip = friction_speed / von_karman * std::log(below / above) * std::sqrt(1 + y * y / (z * z));
    EXPECT_NEAR((c.u[e] - c.u[e - 1]) / slip, 1, 1e-3) << e;
  }
}

TEST(ColumnFlow, OfAMixtureThatIsShearedAsOneIsTheLineOfCouette) {   // the stress is that of eps u + phi v
  TestColumn c({.layers = 30, .thickness = 1e-3, .viscosity = 1e-4});
  c.drive.lid_speed = 0.6;
  for (std::size_t k = 0; k < c.layers(); ++k) {
    const double v = 0.6 * c.middle(k) / c.height(), phi = 0.3 + 0.2 * std::cos(double(k));
    c.solid.fraction[k] = phi, c.solid.flux[k] = phi * v;
    c.exchange.rate[k] = 50, c.exchange.pull[k] = 50 * v;
  }
  c.step(1e3, 5);
  for (std::size_t k = 0; k < c.layers(); ++k) EXPECT_NEAR(c.u[k], 0.6 * c.middle(k) / c.height(), 1e-13);
  for (const double tau : c.flow.stress()) EXPECT_NEAR(tau, 1e-4 * 0.6 / c.height(), 1e-14);
}

TEST(ColumnFlow, IsTurbulentOverGrainsThatReachTheirPackingNowhere) {
  TestColumn c({.layers = 100, .thickness = 1e-4, .viscosity = 1e-6, .top = Top::free_slip, .packing = 0.6});
  TestColumn laminar({.layers = 100, .thickness = 1e-4, .viscosity = 1e-6, .top = Top::free_slip});
  for (TestColumn* t : {&c, &laminar}) {
    add_bed(*t, 0.5, 0.003, 5e-4, 100), t->drive.acceleration = 1;
    t->step(0.1, 1000);
  }
  EXPECT_TRUE(std::isfinite(c.u.back()));
  EXPECT_LT(c.u.back(), 0.5 * laminar.u.back());
}

TEST(ColumnFlow, TurbulentUnderALidBearsTheSameStressOnBothWallsAndMoreThanLaminarFlow) {
  TestColumn c({.layers = 200, .thickness = 5e-5, .viscosity = 1e-6, .packing = 0.6});
  c.drive.lid_speed = 2;   // Re 2e4
  c.step(0.5, 2000);
  const ColumnBooks& b = c.flow.books();
  EXPECT_NEAR(b.on_bottom, -b.on_lid, 1e-11 * b.on_bottom);
  EXPECT_GT(b.on_bottom, 3 * c.column.viscosity * 2 / c.height());   // more than laminar Couette flow bears
}

TEST(ColumnFlow, ClosesItsBookInAnyStep) {
  std::mt19937 bits(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const Top top : {Top::lid, Top::free_slip})
    for (const double packing : {0.0, 0.6}) {
      TestColumn c({.layers = 50,
                    .thickness = 1e-2,
                    .viscosity = 1e-5,
                    .top = top,
                    .packing = packing});   // walls turbulent too
      c.drive = {0.3, 0.4};
      for (std::size_t k = 0; k < c.layers(); ++k) {
        c.u[k] = any(bits);
        c.solid.fraction[k] = 0.45 * (1 + any(bits)), c.solid.flux[k] = c.solid.fraction[k] * any(bits);
        c.exchange.rate[k] = 1e3 * (1 + any(bits)), c.exchange.pull[k] = 1e3 * any(bits);
      }
      for (const double dt : {1e-6, 1e-3, 1.0}) {
        const std::vector<double> before = c.u;
        c.step(dt);
        double gained = 0, size = 0;
        for (std::size_t k = 0; k < c.layers(); ++k) {
          gained += (1 - c.solid.fraction[k]) * (c.u[k] - before[k]) * c.column.thickness / dt;
          size += (1e3 * std::abs(c.u[k]) + std::abs(c.exchange.pull[k])) * c.column.thickness;
        }
        EXPECT_NEAR(c.flow.books().gained, gained, 1e-12 * (size + 1 / dt)) << dt;
        EXPECT_NEAR(c.unbalanced(), 0, 1e-12 * (size + 1 / dt)) << dt;
      }
    }
}

TEST(ColumnFlow, CarriesMomentumWithTheFluidThatGrainsDisplace) {
  std::mt19937 bits(2);
  std::uniform_real_distribution<double> any(0, 1);
  const std::size_t n = 40;
  ColumnFlow flow({.layers = int(n), .thickness = 1e-3, .viscosity = 1e-6});
  std::vector<double> u(n), uniform(n, 0.3), before(n), after(n);
  for (std::size_t k = 0; k < n; ++k) before[k] = 0.9 * any(bits), u[k] = any(bits);
  after = before;
  std::shuffle(after.begin(), after.end(), bits);   // the same solid volume, elsewhere
  const auto [lowest, highest] = std::minmax_element(u.begin(), u.end());
  const double low = *lowest, high = *highest;
  const auto momentum = [&](const std::vector<double>& phi) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += (1 - phi[k]) * u[k];
    return sum;
  };
  const double had = momentum(before);
  flow.carry(u, before, after);
  EXPECT_NEAR(momentum(after), had, 1e-14 * n);
  for (const double v : u) EXPECT_TRUE(v >= low - 1e-14 && v <= high + 1e-14);
  flow.carry(uniform, before, after);
  for (const double v : uniform) EXPECT_NEAR(v, 0.3, 1e-14);
  const std::vector<double> held = u;
  flow.carry(u, after, after);
  for (std::size_t k = 0; k < n; ++k) EXPECT_DOUBLE_EQ(u[k], held[k]);   // nothing moved
}

TEST(ColumnFlow, TakesAnyStiffnessAndFollowsTheGrainsThen) {
  TestColumn c({.layers = 20, .thickness = 1e-4, .viscosity = 1e-6});
  for (std::size_t k = 0; k < c.layers(); ++k)
    c.solid.fraction[k] = 0.5, c.exchange.rate[k] = 1e15, c.exchange.pull[k] = 1e15 * 0.02;
  c.step(1e-3);
  for (const double v : c.u) EXPECT_NEAR(v, 0.02, 1e-8);
}

TEST(ColumnFlow, StaysFiniteInALayerThatGrainsFillAlmostWhole) {
  for (const double packing : {0.0, 0.6})
    for (const double phi : {0.999, 1.0, 1.05}) {
      TestColumn c({.layers = 40, .thickness = 1e-4, .viscosity = 1e-6, .top = Top::free_slip, .packing = packing});
      c.drive.acceleration = 1;
      c.solid.fraction[10] = phi, c.exchange.rate[10] = 1e4;
      c.solid.fraction[11] = 0.5;
      c.step(1e-2, 2000);
      for (const double v : c.u) EXPECT_TRUE(std::isfinite(v) && v >= 0) << phi;
      EXPECT_EQ(c.flow.clamps(), phi > 0.99 ? 1 : 0);
      std::vector<double> moved = c.solid.fraction;
      std::swap(moved[10], moved[20]);
      c.flow.carry(c.u, c.solid.fraction, moved);
      for (const double v : c.u) EXPECT_TRUE(std::isfinite(v)) << phi;
    }
}

TEST(ColumnFlow, SettlesUnderEddiesWhateverTheStep) {   // thin layers, long steps: no ringing of nu_t
  std::vector<double> steady;
  for (const double dt : {1e-2, 1.0, 1e3}) {
    TestColumn c({.layers = 200,
                  .thickness = 1e-4,
                  .viscosity = 1e-6,
                  .top = Top::free_slip,
                  .packing = 0.6,
                  .sand_roughness = 1e-3});
    c.drive.acceleration = 0.05;
    c.step(dt, static_cast<int>(100 + 200 / dt));
    const std::vector<double> before = c.u;
    c.step(dt);
    for (std::size_t k = 0; k < c.layers(); ++k) EXPECT_NEAR(c.u[k] / before[k], 1, 1e-10) << dt;
    if (steady.empty()) steady = c.u;
    EXPECT_NEAR(c.u.back() / steady.back(), 1, 1e-9) << dt;
  }
}

}   // namespace
}   // namespace bedload
