// Drag and torque near plane walls: contact and far limits, published values, and the reflection that the grid resolves.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <complex>
#include <numbers>

#include "solver/coupling/kernel.hpp"
#include "solver/coupling/wall_effects.hpp"

namespace bedload {
namespace {

constexpr double pi = std::numbers::pi;

TEST(NearestWall, IsTheNearestNoSlipPlaneOfTheBox) {
  StaggeredGrid grid;
  grid.cells = {10, 10, 10}, grid.h = {1, 1, 1}, grid.sides = {Side::periodic, Side::wall, Side::wall};
  const auto below = nearest_wall(grid, {0.1, 5, 2});
  ASSERT_TRUE(below);
  EXPECT_EQ(below->axis, 2);
  EXPECT_FALSE(below->upper);
  EXPECT_EQ(below->distance, 2);
  const auto lid = nearest_wall(grid, {0.1, 5, 9.5});
  EXPECT_TRUE(lid->upper && lid->axis == 2 && lid->distance == 0.5);
  EXPECT_EQ(nearest_wall(grid, {5, 9, 5})->axis, 1);
  grid.top = Top::free_slip;
  EXPECT_EQ(nearest_wall(grid, {5, 5, 9.5})->axis, 1);   // a surface without friction is no such wall
  grid.sides = {Side::periodic, Side::periodic, Side::periodic};
  EXPECT_FALSE(nearest_wall(grid, {5, 5, 5}));
}

TEST(WallEffects, VanishFarFromTheWallAsTheFirstImageSays) {
  for (const double k : {1e-3, 1e-2}) {
    EXPECT_NEAR((drag_along_wall(k) - 1) / (9.0 / 16 * k), 1, 0.01);
    EXPECT_NEAR((drag_towards_wall(k) - 1) / (9.0 / 8 * k), 1, 0.05);   // Bevan & Prieve have 7/6
    EXPECT_NEAR((shear_drag_at_wall(k) - 1) / (9.0 / 16 * k), 1, 0.01);
    EXPECT_NEAR((1 - shear_torque_at_wall(k)) / (3.0 / 16 * k * k * k), 1, 1e-4);
    EXPECT_NEAR((spin_torque_at_wall(k) - 1) / (5.0 / 16 * k * k * k), 1, 1e-4);
  }
}

TEST(WallEffects, ATouchingSphereInShearFeelsOneNeilsDragAndTorque) {
  EXPECT_NEAR(shear_drag_at_wall(1), 1.7005, 2e-4);
  EXPECT_NEAR(shear_torque_at_wall(1), 0.944, 1e-4);
}

TEST(WallEffects, MeetTheTablesOfGoldmanCoxAndBrenner) {
  // z/a; drag along the wall; torque in shear (Goldman, Cox & Brenner 1967, Chem. Eng. Sci. 22, 637 and 653).
  const double table[][3] = {{10.0677, 1.0591, 0.99981}, {3.7622, 1.1738, 0.99711}, {2.3524, 1.3079, 0.99010},
                             {1.5431, 1.5675, 0.97419},  {1.1276, 2.1514, 0.95374}, {1.0453, 2.6475, 0.94769}};
  for (const auto& [z, drag, torque] : table) {
    EXPECT_NEAR(drag_along_wall(1 / z) / drag, 1, 0.05) << z;
    EXPECT_NEAR(shear_torque_at_wall(1 / z), torque, 6e-3) << z;
  }
}

/// Brenner 1961 (Chem. Eng. Sci. 16, 242): sphere that moves towards a plane, z/a = cosh(alpha).
double brenner(double k) {
  const double alpha = std::acosh(1 / k);
  double sum = 0;
  for (int n = 1; n < 400; ++n) {
    const double m = 2 * n + 1;
    const double top = 2 * std::sinh(m * alpha) + m * std::sinh(2 * alpha);
    const double bottom = 4 * std::pow(std::sinh((n + 0.5) * alpha), 2) - m * m * std::pow(std::sinh(alpha), 2);
    if (!std::isfinite(bottom)) break;
    sum += n * (n + 1.0) / ((2 * n - 1.0) * (2 * n + 3.0)) * (top / bottom - 1);
  }
  return 4.0 / 3 * std::sinh(alpha) * sum;
}

TEST(WallEffects, TowardsTheWallIsBrennersSeries) {
  EXPECT_NEAR(brenner(1 / 10.0677), 1.1252, 1e-3);   // his table
  for (double gap = 0.1; gap < 50; gap *= 1.3)
    EXPECT_NEAR(drag_towards_wall(1 / (1 + gap)) / brenner(1 / (1 + gap)), 1, 0.05) << gap;
}

TEST(WallEffects, StayFiniteAndGrowTowardsContact) {
  for (double k = 0.01; k < 1.2; k += 0.01) {   // overlapping the wall too
    EXPECT_TRUE(std::isfinite(drag_along_wall(k) + drag_towards_wall(k) + spin_torque_at_wall(k)));
    EXPECT_GE(drag_along_wall(k + 0.01), drag_along_wall(k));
    EXPECT_GE(drag_towards_wall(k + 0.01), drag_towards_wall(k));
    EXPECT_GE(spin_torque_at_wall(k + 0.01), spin_torque_at_wall(k));
    EXPECT_LE(shear_torque_at_wall(k + 0.01), shear_torque_at_wall(k));
    EXPECT_GE(drag_towards_wall(k), drag_along_wall(k));
  }
  EXPECT_NEAR(drag_along_wall(1), 0.9588 - 8.0 / 15 * std::log(0.01), 1e-12);
}

TEST(WallEffects, AreOffAmongOtherGrains) {
  const WallDrag none = wall_drag({2, false, 0.5}, 1, {}, {0.2, 0.2, 0.3}, 0);
  EXPECT_EQ(none.slip, (Vec3{1, 1, 1}));
  EXPECT_EQ(none.flow, Vec3{});
}

/// What a grain feels in all, in units of a lone grain's drag, if the grid reflects R and gives the grain's own drag kappa:
/// solves f = slip (u_s - v) + flow u_s, u_s = u + (R - kappa) f, for beta corrected by 1/(1 - removed).
double felt(double slip, double flow, double u, double v, double kappa, double reflected, double removed) {
  const double beta = 1 / (1 - removed);
  return beta * (slip * (u - v) + flow * u) / (1 - beta * (slip + flow) * (reflected - kappa));
}

TEST(WallDrag, IsTheTargetWhateverTheGridReflects) {
  const double d = 1, z = 0.8, k = 0.5 / z;
  for (const double reflected : {0.0, 0.1, 0.3}) {
    for (const double kappa : {0.3, 0.6}) {   // removed by the drag coefficient's own correction
      const Vec3 each{kappa, kappa, kappa}, back{reflected, reflected, reflected};
      const WallDrag wall = wall_drag({2, false, z}, d, each, back, 1);
      const double along = felt(wall.slip.x, wall.flow.x, 0.7, 0.2, kappa, reflected, kappa);
      EXPECT_NEAR(along, shear_drag_at_wall(k) * 0.7 - drag_along_wall(k) * 0.2, 1e-12);
      const double towards = felt(wall.slip.z, wall.flow.z, 0, 0.2, kappa, reflected, kappa);
      EXPECT_NEAR(towards, -drag_towards_wall(k) * 0.2, 1e-12);
      const double sampled = 0.7 + (reflected - kappa) * along;
      EXPECT_NEAR(wall.undisturbed({sampled, 0, 0}, {0.2, 0, 0}).x, 0.7, 1e-12);
      EXPECT_NEAR(wall.applied.x, 1 / (1 + shear_drag_at_wall(k) * (reflected - kappa)), 1e-12);
    }
    // Without such a correction kappa is left in, and only the wall's part is right.
    const WallDrag raw = wall_drag({2, false, z}, d, {}, {reflected, reflected, reflected}, 1);
    EXPECT_NEAR(felt(raw.slip.z, raw.flow.z, 0, 0.2, 0, reflected, 0), -drag_towards_wall(k) * 0.2, 1e-12);
  }
}

TEST(WallDrag, OfATouchingSphereAtRestInShearIsOneNeils) {
  const WallDrag wall = wall_drag({2, false, 0.5}, 1, {}, {}, 1);   // one-way: the grid reflects nothing
  EXPECT_NEAR(wall.slip.x + wall.flow.x, 1.7005, 2e-4);             // v = 0
  EXPECT_NEAR(wall.slip.y + wall.flow.y, 1.7005, 2e-4);
}

// The discrete Stokes equations on a staggered grid with cells 1 x 1 x hz between no-slip walls, Fourier modes in x and y,
// solved mode by mode for the response of a grain's kernel to a unit force, sampled by the same kernel.
class DiscreteStokes {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  DiscreteStokes(double hz, int modes, int planes)
      : hz_(hz),
        n_(modes),
        nz_(planes),
        diffuse_(second_difference(nz_, -3)),
        diffuse_z_(second_difference(nz_ - 1, -2)) {
    gradient_ = Matrix::Zero(nz_ - 1, nz_);
    for (int i = 0; i < nz_ - 1; ++i) gradient_(i, i) = -1 / hz, gradient_(i, i + 1) = 1 / hz;
  }

  /// mu h_x/force x velocity sampled, for a force along x (axis 0) or z (2), at each height.
  Vector response(int axis, const std::vector<double>& heights) const {
    const Matrix weights = axis == 0 ? cell_weights(heights) : face_weights(heights);
    const int inner = nz_ - 1, size = 2 * nz_ + inner, first = axis == 0 ? 0 : nz_;
    Matrix rhs = Matrix::Zero(size, weights.cols());
    rhs.middleRows(first, weights.rows()) = -weights / hz_;
    Vector sum = Vector::Zero(weights.cols());
    const auto add = [&](double share, const Matrix& x) {
      sum += share * weights.cwiseProduct(x).colwise().sum().transpose();
    };
    for (int a = 0; a <= n_ / 2; ++a)
      for (int b = 0; b <= n_ / 2; ++b) {
        const double sx = 2 * std::sin(pi * a / n_), sy = 2 * std::sin(pi * b / n_), l = sx * sx + sy * sy;
        const double both = (a % (n_ / 2) == 0 ? 1 : 2) * (b % (n_ / 2) == 0 ? 1 : 2);   // modes a and -a, b and -b
        const double share = both * transform(a, axis == 0) * transform(b, false) / (n_ * n_);
        const double along_wave = l > 0 ? sx * sx / l : 0;   // of a force along x
        const Matrix diffusion = diffuse_ - l * Matrix::Identity(nz_, nz_);
        if (axis == 0) add(share * (1 - along_wave), diffusion.partialPivLu().solve(-weights / hz_));
        if (l == 0) continue;
        // Velocity along the wave vector, velocity along z, pressure (each times the i that makes it real).
        Matrix m = Matrix::Zero(size, size);
        m.block(0, 0, nz_, nz_) = diffusion;
        m.block(nz_, nz_, inner, inner) = diffuse_z_ - l * Matrix::Identity(inner, inner);
        m.block(0, nz_ + inner, nz_, nz_) = std::sqrt(l) * Matrix::Identity(nz_, nz_);
        m.block(nz_, nz_ + inner, inner, nz_) = -gradient_;
        m.block(nz_ + inner, 0, nz_, nz_) = std::sqrt(l) * Matrix::Identity(nz_, nz_);
        m.block(nz_ + inner, nz_, nz_, inner) = -gradient_.transpose();
        const Matrix x = m.partialPivLu().solve(rhs);
        add(share * (axis == 0 ? along_wave : 1), x.middleRows(first, weights.rows()));
      }
    return sum;
  }
  double height() const { return nz_ * hz_; }
  double hz() const { return hz_; }
  int planes() const { return nz_; }

 private:
  Matrix second_difference(int n, double at_wall) const {
    Matrix m = Matrix::Zero(n, n);
    for (int i = 0; i < n; ++i) {
      m(i, i) = i == 0 || i == n - 1 ? at_wall : -2;
      if (i > 0) m(i, i - 1) = m(i - 1, i) = 1;
    }
    return m / (hz_ * hz_);
  }
  Matrix cell_weights(const std::vector<double>& heights) const {
    Matrix w = Matrix::Zero(nz_, static_cast<int>(heights.size()));
    for (int q = 0; q < w.cols(); ++q) {
      const double s = heights[q] / hz_, k = std::floor(s);
      const auto spline = quadratic_spline(s - k - 0.5);
      for (int j = 0; j < 3; ++j) w(std::clamp(static_cast<int>(k) - 1 + j, 0, nz_ - 1), q) += spline[j];   // folded
    }
    return w;
  }
  Matrix face_weights(const std::vector<double>& heights) const {   // walls carry nothing
    Matrix w = Matrix::Zero(nz_ + 1, static_cast<int>(heights.size()));
    for (int q = 0; q < w.cols(); ++q) {
      const double s = heights[q] / hz_, k = std::floor(s);
      w(static_cast<int>(k), q) += 1 - (s - k), w(static_cast<int>(k) + 1, q) += s - k;
    }
    return w.middleRows(1, nz_ - 1);
  }
  /// Squared transform of the kernel's weights along one direction, for a grain at the quarter of a cell.
  double transform(int a, bool along_normal) const {
    const double k = 2 * pi * a / n_;
    if (along_normal) return std::norm(0.75 + 0.25 * std::polar(1.0, -k));
    const auto spline = quadratic_spline(-0.25);
    std::complex<double> sum;
    for (int j = 0; j < 3; ++j) sum += spline[j] * std::polar(1.0, -k * j);
    return std::norm(sum);
  }
  double hz_;
  int n_, nz_;
  Matrix diffuse_, diffuse_z_, gradient_;
};

class Reflection : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(WallEffects, Reflection, testing::Values(1.0, 0.5, 0.25));

TEST_P(Reflection, IsWhatTheDiscreteEquationsGive) {
  const double hz = GetParam(), d = 0.5, mobility = 3 * pi * d;   // kappa of a lone grain = 3 pi d K, edges of 1
  const DiscreteStokes stokes(hz, 40, static_cast<int>(26 / std::sqrt(hz)));
  const double top = stokes.height(), middle = stokes.planes() / 2 * hz;
  const std::vector<double> cells{0.75, 1, 1.5, 2, 2.5, 3};
  std::vector<double> heights;
  for (const double c : cells) heights.push_back(c * hz);
  for (const double c : cells) heights.push_back(middle + (c - std::floor(c)) * hz);   // the same places far from walls
  for (const int axis : {0, 2}) {
    const auto k = stokes.response(axis, heights);
    // The two walls of a channel together reflect 1.004 (1.4516) a/(half height) at its middle (Faxen 1922, Brenner 1961);
    // near one wall, the other's first image is taken away.
    const double image = (axis == 0 ? 9.0 / 16 : 9.0 / 8) / (6 * pi);
    const double channel = (axis == 0 ? 1.004 : 1.4516) / (3 * pi * top);
    const std::size_t n = cells.size();
    const double kappa = mobility * (0.5 * (k[n + 1] + k[n + 2]) + channel);   // mean of whole and half places
    EXPECT_NEAR(mean_response(axis == 0, d, hz, 1) / kappa, 1, 0.06);
    for (std::size_t i = 0; i < n; ++i) {
      const double resolved = mobility * (k[n + i] + channel - k[i] - image / (top - heights[i]));
      EXPECT_NEAR(resolved_reflection(axis == 0, heights[i], d, kappa, hz, 1), resolved, 0.05 * kappa)
          << "axis " << axis << ", " << cells[i] << " cells";
    }
  }
}

TEST(ResolvedReflection, IsTheFirstImageFarOffAndNeverMoreThanKappa) {
  EXPECT_NEAR(resolved_reflection(true, 40, 1, 0.6, 1, 1) / (9.0 / 16 * 0.5 / 40), 1, 1e-2);
  EXPECT_NEAR(resolved_reflection(false, 40, 1, 0.6, 1, 1) / (9.0 / 8 * 0.5 / 40), 1, 1e-2);
  for (const double z : {0.0, 0.1, 0.5, 1.0})
    for (const bool along : {true, false}) EXPECT_LE(resolved_reflection(along, z, 1, 0.3, 0.5, 1), 0.3);
}

}   // namespace
}   // namespace bedload
