// The table of damping against the Stokes number, and the speed that sets its scale.
#include "solver/grains/wet_restitution.hpp"

#include <numbers>

#include "solver/grains/contact_laws.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

namespace {

/// The inverse of restitution_of_damping for ever lower restitutions: interpolated, at a thirtieth of the cost.
class DampingAscent {
 public:
  double damping_of(double restitution) {
    while (e_high_ > restitution) {
      low_ = high_, e_low_ = e_high_;
      high_ += step;
      e_high_ = restitution_of_damping(high_);
    }
    return low_ + (high_ - low_) * (e_low_ - restitution) / (e_low_ - e_high_);
  }

 private:
  static constexpr double step = 0.04;   // of alpha; the restitution is then right within 3e-4
  double low_ = 0, e_low_ = 1, high_ = step, e_high_ = restitution_of_damping(step);
};

}   // namespace

// Powers by multiplication: the same bits on every machine.
WetRestitution::WetRestitution(const FluidProperties& fluid, double dry_restitution)
    : viscosity_(fluid.density * fluid.viscosity), fluid_density_(fluid.density) {
  constexpr double lowest = HertzMindlin::lowest_restitution;
  constexpr double ratio = 0.93941306281347578611;   // exp(-1/16)
  DampingAscent ascent;
  double restitution = std::max(dry_restitution, lowest);
  table_.push_back(damping_of_restitution(restitution));   // no liquid, no change
  while ((restitution *= ratio) > lowest) table_.push_back(ascent.damping_of(restitution));
  table_.push_back(damping_of_restitution(lowest));
}

/// Of the grain and half the liquid that it displaces [1/kg]; the mass of the solid follows from its inertia.
double WetRestitution::inverse_mass(SolidSphere body) const noexcept {
  if (body.inverse_inertia == 0) return 0;
  const double d = 2 * body.radius, mass = 1 / (body.inverse_inertia * sphere_inertia(1, d));
  return 1 / (mass + 0.5 * fluid_density_ * sphere_volume(d));
}

double WetRestitution::viscous_speed(SolidSphere a, SolidSphere b) const noexcept {
  const double radius = a.radius * b.radius / (a.radius + b.radius);
  return decay * 6 * std::numbers::pi * viscosity_ * radius * radius * (inverse_mass(a) + inverse_mass(b));
}

double WetRestitution::viscous_speed_at_wall(SolidSphere body) const noexcept {
  return decay * 6 * std::numbers::pi * viscosity_ * body.radius * body.radius * inverse_mass(body);
}

}   // namespace bedload
