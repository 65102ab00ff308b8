#include "solver/coupling/self_disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/coupling/kernel.hpp"

namespace bedload {
namespace {

using std::numbers::pi;

// More points and nodes than these move nothing by 0.1 % of the largest entry.
constexpr int points = 24;   // of a Gauss-Legendre rule
constexpr int images = 3;    // wave numbers k + 2 pi m, |m| <= 3: the hat's transform falls as 1/m^2
constexpr int nodes = 32;    // of the tables
constexpr double first_re = 0.2, last_re = 500;   // Reynolds numbers of the cell: nodes are even in asinh(re/first_re)
const double last_place = std::asinh(last_re / first_re);

double node_re(int n) { return first_re * std::sinh(last_place * n / (nodes - 1)); }

struct Quadrature {
  std::array<double, points> x, w;
};

/// Gauss-Legendre on [0, 1], the roots by Newton's method.
Quadrature gauss_legendre() {
  Quadrature rule{};
  for (int i = 0; i < points; ++i) {
    double z = std::cos(pi * (i + 0.75) / (points + 0.5)), slope = 1;
    for (int iteration = 0; iteration < 20; ++iteration) {
      double p = 1, before = 0;
      for (int j = 0; j < points; ++j) {
        const double next = ((2 * j + 1) * z * p - j * before) / (j + 1);
        before = p, p = next;
      }
      slope = points * (z * p - before) / (z * z - 1);
      z -= p / slope;
    }
    rule.x[i] = 0.5 * (1 - z), rule.w[i] = 1 / ((1 - z * z) * slope * slope);
  }
  return rule;
}

/// A rule on [0, pi] with its points crowded at 0 on the scale c: k = c sinh t.
Quadrature crowded(const Quadrature& rule, double c) {
  Quadrature out;
  const double end = std::asinh(pi / c);
  for (int i = 0; i < points; ++i) {
    const double s = std::sinh(end * rule.x[i]);
    out.x[i] = c * s, out.w[i] = end * rule.w[i] * c * std::sqrt(1 + s * s);
  }
  return out;
}

/// |sum of the B-spline's three weights exp(-i k n)|^2 as a polynomial in the square of the offset from the middle cell.
std::array<double, 3> spline_power(double k) {
  const double c1 = std::cos(k), c2 = std::cos(2 * k);
  return {(19 + 12 * c1 + c2) / 32, (-3 + 4 * c1 - c2) / 4, (3 - 4 * c1 + c2) / 2};
}

/// |sum of the hat's two weights exp(-i k n)|^2 as a mean and a multiple of hat_shape; rise = 1 - cos k.
std::array<double, 2> hat_power(double rise) { return {1 - rise / 3, 2 / (pi * pi) * rise}; }
/// What depends on the fraction f of the way from face to face: mean zero, first harmonic cos(2 pi f).
double hat_shape(double f) { return pi * pi * (1.0 / 6 - f * (1 - f)); }

struct AlongMotion {
  double mean = 0, cosine = 0, sine = 0;   // of the drag response over the fraction of the way from face to face
  double stress = 0, steady_stress = 0;
  double displacement = 0, displacement_shape = 0;
  double steady[2] = {};   // of one face on itself and on the next
};

/// The integrals over the wave number along the force, for given squared differences `across` of the other two [1/m2].
/// speed: of the motion along it over nu [1/m].
AlongMotion integrate_along(const Quadrature& rule, double across, double h, double speed) {
  AlongMotion sum;
  const double root = std::sqrt(across);
  const Quadrature line = crowded(rule, std::min(1.0, h * across / (root + speed)));
  for (int i = 0; i < points; ++i) {
    const double k = line.x[i], half = std::sin(k / 2), along = 4 * half * half / (h * h), total = across + along;
    const double transverse = line.w[i] * across / total;
    double weight[2 * images + 3];   // transforms of the hat at k + 2 pi m
    for (int m = 0; m < 2 * images + 3; ++m) {
      const double sinc = half / (k / 2 + pi * (m - images - 1));
      weight[m] = sinc * sinc;
    }
    for (int m = 1; m <= 2 * images + 1; ++m) {
      const double frequency =
          speed * (k + 2 * pi * (m - images - 1)) / h;   // over nu, at which the force passes a wave
      const double gain = transverse * weight[m] / (total * total + frequency * frequency);
      sum.mean += gain * weight[m] * total;
      sum.cosine += gain * (weight[m + 1] + weight[m - 1]) * total;
      sum.sine += gain * (weight[m - 1] - weight[m + 1]) * frequency;
      sum.stress += gain * weight[m] * total * total;
      sum.steady_stress += transverse * weight[m] * weight[m];
    }
    sum.steady[0] += transverse / total, sum.steady[1] += transverse / total * (1 - 2 * half * half);
    const auto hat = hat_power(2 * half * half);
    sum.displacement += line.w[i] * along / total * hat[0];
    sum.displacement_shape += line.w[i] * along / total * hat[1];
  }
  return sum;
}

/// The integrals over all wave numbers for one axis and one speed.
struct Response {
  std::array<double, 27> drag{}, displacement{};
  std::array<double, 18> steady{};
  double stress = 0, steady_stress = 0;   // means over all places
};

/// Adds what the waves with numbers ka, kb across the force contribute, of the share `area` of all of them.
void add_waves(const AlongMotion& along, double ka, double kb, double area, Response& sum) {
  const auto a = spline_power(ka), b = spline_power(kb);
  for (int p = 0; p < 3; ++p)
    for (int q = 0; q < 3; ++q) {
      const double w = area * a[p] * b[q];
      const int n = 3 * p + q;
      sum.drag[n] += w * along.mean, sum.drag[9 + n] += w * along.cosine, sum.drag[18 + n] += w * along.sine;
      sum.displacement[n] += w * along.displacement, sum.displacement[9 + n] += w * along.displacement_shape;
    }
  const double ca[3] = {1, std::cos(ka), std::cos(2 * ka)}, cb[3] = {1, std::cos(kb), std::cos(2 * kb)};
  for (int l = 0; l < 18; ++l) sum.steady[l] += area * along.steady[l / 9] * ca[l / 3 % 3] * cb[l % 3];
  // p and p^2 are 1/12 and 1/80 in the mean over places
  const double everywhere = area * (a[0] + a[1] / 12 + a[2] / 80) * (b[0] + b[1] / 12 + b[2] / 80);
  sum.stress += everywhere * along.stress, sum.steady_stress += everywhere * along.steady_stress;
}

/// speed: of the motion along axis c over nu [1/m].
Response integrate(const Quadrature& rule, const StaggeredGrid& grid, int c, double speed) {
  const double h = grid.h[c], ha = grid.h[(c + 1) % 3], hb = grid.h[(c + 2) % 3];
  const Quadrature radius = crowded(rule, std::min(1.0, 0.1 + speed * std::cbrt(grid.cell_volume())));
  Response sum;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) {   // the two triangles of a square: r and r t across, and the other way round
      const double far = radius.x[i], near = far * rule.x[j], area = radius.w[i] * rule.w[j] * far / (pi * pi * pi);
      const auto along = [&](double ka, double kb) {
        const double sa = 2 * std::sin(ka / 2) / ha, sb = 2 * std::sin(kb / 2) / hb;
        return integrate_along(rule, sa * sa + sb * sb, h, speed);
      };
      const AlongMotion first = along(far, near);
      add_waves(first, far, near, area, sum);
      add_waves(ha == hb ? first : along(near, far), near, far, area, sum);
    }
  for (double& entry : sum.drag) entry /= grid.cell_volume();
  for (double& entry : sum.steady) entry /= grid.cell_volume();
  return sum;
}

/// The response along an axis whose two others have changed places.
Response mirrored(const Response& r) {
  Response out = r;
  const auto mirror = [](auto& to, const auto& from) {
    for (std::size_t n = 0; n < to.size(); ++n) to[n] = from[9 * (n / 9) + 3 * (n % 3) + n / 3 % 3];
  };
  mirror(out.drag, r.drag), mirror(out.displacement, r.displacement), mirror(out.steady, r.steady);
  return out;
}

/// By axis; what follows from another axis by symmetry of the cell is not computed again.
std::array<Response, 3> responses(const StaggeredGrid& grid, double speed) {
  const Quadrature rule = gauss_legendre();
  const Vec3 h = grid.h;
  const Response x = integrate(rule, grid, 0, speed);
  const Response y = h.x == h.y ? mirrored(x) : integrate(rule, grid, 1, speed);
  const Response z = h.x == h.y && h.y == h.z ? x : integrate(rule, grid, 2, speed);
  return {x, y, z};
}

}   // namespace

SelfDisturbance::SelfDisturbance(const StaggeredGrid& grid)
    : grid_(grid), edge_(std::cbrt(grid.cell_volume())), nodes_(nodes) {
  node(0);
}

const SelfDisturbance::Node& SelfDisturbance::node(int n) const {
  if (!nodes_[n]) {
    const auto response = responses(grid_, node_re(n) / edge_);
    Node& made = nodes_[n].emplace();
    for (int c = 0; c < 3; ++c)
      made[c] = {response[c].drag, response[c].stress / response[c].steady_stress, response[c].displacement,
                 response[c].steady};
  }
  return *nodes_[n];
}

double SelfDisturbance::unevenness(const Axis& table, const double (&along)[2], const std::array<double, 3>& a,
                                   const std::array<double, 3>& b) const noexcept {
  double mean = 0, square = 0;
  for (int l = 0; l < 2; ++l)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double u = 0;
        for (int m = 0; m < 2; ++m)
          for (int p = 0; p < 3; ++p)
            for (int q = 0; q < 3; ++q)
              u += along[m] * a[p] * b[q] * table.steady[9 * (l != m) + 3 * std::abs(i - p) + std::abs(j - q)];
        const double w = along[l] * a[i] * b[j];
        mean += w * u, square += w * u * u;
      }
  return square / (mean * mean) - 1;
}

OwnFlow SelfDisturbance::at(Vec3 position, Vec3 slip, double viscosity) const noexcept {
  Vec3 fraction;
  for (int c = 0; c < 3; ++c) {
    const double s = position[c] / grid_.h[c];
    fraction[c] = s - cell_of(s, grid_.cells[c]);
  }
  const double speed = norm(slip), re = speed * edge_ / viscosity;
  const double place = std::min(std::asinh(re / first_re) / last_place, 1.0) * (nodes - 1);
  const int low = std::min(static_cast<int>(place), nodes - 2);
  const double beyond = re > last_re ? last_re / re : 1, next = place - low;
  const Node &still = node(0), &below = node(low), &above = node(low + 1);
  OwnFlow own;
  Vec3 steady;
  double fade = 0, stress_fade = 0;
  for (int c = 0; c < 3; ++c) {
    const double f = fraction[c], lag = (slip[c] > 0 ? -1 : 1) * std::sin(2 * pi * f);
    const double along[3] = {1, hat_shape(f), lag};
    const double oa = fraction[(c + 1) % 3] - 0.5, ob = fraction[(c + 2) % 3] - 0.5, pa = oa * oa, pb = ob * ob;
    const double a[3] = {1, pa, pa * pa}, b[3] = {1, pb, pb * pb};
    const auto value = [&](const Shape& shape) {
      double sum = 0;
      for (int l = 0; l < 3; ++l)
        for (int p = 0; p < 3; ++p)
          for (int q = 0; q < 3; ++q) sum += shape[9 * l + 3 * p + q] * along[l] * a[p] * b[q];
      return sum;
    };
    steady[c] = value(still[c].drag);
    const double moving = beyond * ((1 - next) * value(below[c].drag) + next * value(above[c].drag));
    const double share = speed > 0 ? slip[c] * slip[c] / (speed * speed) : 1.0 / 3;
    fade += share * moving / steady[c];
    stress_fade += share * beyond * ((1 - next) * below[c].stress + next * above[c].stress);
    own.displacement[c] = value(still[c].displacement);
    const auto wa = quadratic_spline(oa), wb = quadratic_spline(ob);
    own.stress[c] = (f * f + (1 - f) * (1 - f)) * (wa[0] * wa[0] + wa[1] * wa[1] + wa[2] * wa[2]) *
                    (wb[0] * wb[0] + wb[1] * wb[1] + wb[2] * wb[2]);
    own.unevenness[c] = unevenness(still[c], {1 - f, f}, wa, wb);
  }
  own.drag = fade * steady;
  own.unevenness = own.unevenness / fade;
  own.stress = own.displacement + stress_fade * (own.stress - own.displacement);
  return own;
}

}   // namespace bedload
