// Contact: collisions, friction and rolling of one or two grains, dry and wet.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "studies/svg_plot.hpp"
#include "studies/validation.hpp"

namespace bedload {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

// ---- Two spheres, head-on

/// Of two grains that meet along x: when their surfaces touch and part, how deep they overlap, how fast they part.
struct Collision {
  double duration = nan;      // [s]
  double overlap = nan;       // deepest [m]
  double restitution = nan;   // parting over approach speed [-]
};

/// Before and after the contact grains fly free: its ends follow from the gap and the speed of the rows next to it.
Collision head_on(const FinishedCase& run) {
  const Trajectory left = trajectory_of(run, 0), right = trajectory_of(run, 1);
  const double d = run.input("grains.diameter");
  const auto overlap = [&](std::size_t n) { return d - (right.position[n].x - left.position[n].x); };
  const auto closing = [&](std::size_t n) { return left.velocity[n].x - right.velocity[n].x; };
  std::size_t first = 0;
  while (first < left.size() && overlap(first) <= 0) ++first;
  std::size_t after = first;
  Collision seen;
  seen.overlap = 0;
  for (; after < left.size() && overlap(after) > 0; ++after) seen.overlap = std::max(seen.overlap, overlap(after));
  if (first == 0 || after >= left.size()) return {};
  const double met = left.time[first - 1] - overlap(first - 1) / closing(first - 1);
  const double parted = left.time[after] - overlap(after) / closing(after);
  seen.duration = parted - met;
  seen.restitution = -closing(after) / closing(first - 1);
  return seen;
}

Findings hertz(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const auto& g = run.one.scene.bed.grains;
    const double d = g.diameter, mass = g.density * std::numbers::pi / 6 * d * d * d / 2, radius = d / 4;
    const double modulus = g.young_modulus / (2 * (1 - g.poisson * g.poisson));
    const Trajectory left = trajectory_of(run, 0), right = trajectory_of(run, 1);
    const double speed = left.velocity.front().x - right.velocity.front().x;
    const Collision seen = head_on(run);
    const double duration = 2.87 * std::pow(mass * mass / (radius * modulus * modulus * speed), 0.2);
    const double overlap = std::pow(15 * mass * speed * speed / (16 * modulus * std::sqrt(radius)), 0.4);
    found.rows.push_back({.name = fmt::format("duration of a collision at {:.2g} m/s [us]", speed),
                          .reference = 1e6 * duration,
                          .source = "Hertz 1882",
                          .ours = 1e6 * seen.duration,
                          .band = Band::within(0.01)});
    found.rows.push_back({.name = fmt::format("deepest overlap at {:.2g} m/s [um]", speed),
                          .reference = 1e6 * overlap,
                          .source = "Hertz 1882",
                          .ours = 1e6 * seen.overlap,
                          .band = Band::within(0.01)});
  }
  return found;
}

Findings restitution(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const double asked = run.input("grains.restitution");
    found.rows.push_back({.name = fmt::format("restitution, asked for {:.2g} [-]", asked),
                          .reference = asked,
                          .source = "grains.restitution of the study file",
                          .ours = head_on(run).restitution,
                          .band = Band::within_absolute(0.01)});
  }
  return found;
}

// ---- A sphere strikes a plate

/// Tangential over normal speed of the point of contact, before and after; both over the normal speed before.
struct Impact {
  double before, after;
};

std::vector<Impact> impacts(const FinishedCase& run) {
  const double radius = run.input("grains.diameter") / 2;
  std::vector<Impact> seen;
  for (const auto grain : run.one.scene.record.tracks) {
    const Trajectory path = trajectory_of(run, grain);
    const double normal = -path.velocity.front().z;
    const auto tangential = [&](std::size_t n) { return path.velocity[n].x - radius * path.spin[n].y; };
    const bool left = path.velocity.back().z > 0 && path.position.back().z > radius;
    seen.push_back({tangential(0) / normal, left ? tangential(path.size() - 1) / normal : nan});
  }
  return seen;
}

/// What Foerster, Louge, Chang & Allia (1994) measured for a sphere against a plate of the same material.
struct Material {
  std::string_view name;
  double restitution, friction, tangential;            // e, mu, beta_0
  double of_restitution, of_friction, of_tangential;   // +- of these, as published
};

std::string rebound_figure(const Material& m, const std::vector<Impact>& seen) {
  const double stop = 3.5 * (1 + m.restitution) * m.friction, sticks_below = stop / (1 + m.tangential);
  const double span = 2.2 * stop;
  SvgPlot plot(640, 330, {"tangential over normal speed before, Psi1", 0, span},
               {"the same after, Psi2", -0.4 * stop, 1.2 * stop}, 190);
  plot.line({{0, 0}, {span, 0}}, {"#c6ced3", 1, ""});
  plot.line({{sticks_below, sticks_below - stop}, {span, span - stop}}, {"#333", 1.5, ""});
  plot.line({{0, 0}, {sticks_below, -m.tangential * sticks_below}}, {"#333", 1.5, "5 3"});
  for (const auto& one : seen)
    plot.marker({one.before, one.after}, Marker::circle, "#0b6e99", true,
                fmt::format("{:.3g} -> {:.4g}", one.before, one.after));
  plot.legend_line("sliding, exact", {"#333", 1.5, ""});
  plot.legend_line("sticking, measured", {"#333", 1.5, "5 3"});
  plot.legend_marker("bedload", Marker::circle, "#0b6e99", true);
  return plot.svg();
}

/// A contact slides from beginning to end above this Psi1 (Maw, Barber & Fawcett 1976, elastic spheres on a plane).
double sliding_throughout(const Material& m, double poisson) {
  const double ratio = (1 - poisson) / (1 - poisson / 2);   // of tangential to normal stiffness
  return m.friction * (7 - 1 / ratio);
}

/// Between the plate's normal and the way the centre leaves [deg]: of the slip that the collision took away, 2/7 went from
/// the sphere's speed and 5/7 into its spin.
double rebound_angle(const Impact& one, const Material& m) {
  return degrees(std::atan((one.before - 2.0 / 7 * (one.before - one.after)) / m.restitution));
}

/// What the published +- of e and beta_0 (mu has no part in sticking) make of the measured angle, in quadrature [deg].
double angle_uncertainty(double before, const Material& m) {
  const auto angle = [&](double e, double beta) {
    Material other = m;
    other.restitution = e;
    return rebound_angle({before, -beta * before}, other);
  };
  const double e = m.restitution, beta = m.tangential;
  return std::hypot(angle(e + m.of_restitution, beta) - angle(e - m.of_restitution, beta),
                    angle(e, beta + m.of_tangential) - angle(e, beta - m.of_tangential)) /
         2;
}

/// [deg]; an angle of less would pass without any rebound. Not the uncertainty of the measurement, which is a tenth of it at small
/// Psi1: the springs of Hertz and Mindlin take e and mu in, but no beta_0, and come this near to it.
constexpr double angle_band = 4;

Findings foerster(const std::vector<FinishedCase>& runs, const Material& m) {
  Findings found;
  for (const auto& run : runs) {
    const auto seen = impacts(run);
    const double slides_from = sliding_throughout(m, run.input("grains.poisson"));
    const double stop = 3.5 * (1 + m.restitution) * m.friction, sticks_below = stop / (1 + m.tangential);
    for (const auto& one : seen) {
      if (one.before > slides_from)
        found.rows.push_back({.name = fmt::format("{}, Psi2 at Psi1 = {:.3g}, sliding [-]", m.name, one.before),
                              .reference = one.before - stop,
                              .source = "impulse of sliding friction: Psi1 - (7/2)(1 + e) mu",
                              .ours = one.after,
                              .band = Band::within(0.01)});
      else if (one.before < sticks_below && rebound_angle({one.before, -m.tangential * one.before}, m) > angle_band)
        found.rows.push_back(
            {.name = fmt::format("{}, rebound at Psi1 = {:.3g}, sticking [deg]", m.name, one.before),
             .reference = rebound_angle({one.before, -m.tangential * one.before}, m),
             .source = fmt::format("Foerster et al. 1994: Psi2 = -beta0 Psi1, measured to +-{:.2g} deg; "
                                   "the band is of a model without beta0",
                                   angle_uncertainty(one.before, m)),
             .ours = rebound_angle(one, m),
             .band = Band::within_absolute(angle_band),
             .against = Against::experiment});
    }
    found.figures.push_back(
        {fmt::format("contact-foerster-{}", m.name),
         fmt::format(
             "Tangential speed of the point of contact after a collision with a plate over that before, {}: e = "
             "{} +- {}, mu = {} +- {}, beta0 = {} +- {} (Foerster, Louge, Chang & Allia 1994). Contacts take in e and "
             "mu "
             "and know no beta0: at small Psi1 they miss the measured angle by more than its uncertainty, which +- of "
             "e "
             "and beta0 make; the rows allow {} deg, a demand on the model.",
             m.name, m.restitution, m.of_restitution, m.friction, m.of_friction, m.tangential, m.of_tangential,
             angle_band),
         rebound_figure(m, seen)});
  }
  return found;
}

// ---- A sphere bounces in a liquid

/// Rebound over dry rebound of spheres in a liquid (Legendre, Zenit, Daniel & Guiraud 2006, through the data of Joseph et al.
/// 2001 and Gondret et al. 2002).
double wet_rebound(double stokes) { return std::exp(-35 / stokes); }

/// (rho_p + rho_f/2) d U/(9 mu) of an approach at `speed`.
double stokes_number(const FinishedCase& run, double speed) {
  const double rho = run.input("fluid.density");
  return (run.input("grains.density") + rho / 2) * run.input("grains.diameter") * speed /
         (9 * rho * run.input("fluid.viscosity"));
}

std::string bounce_figure(const std::vector<ValidationRow>& rows, const std::vector<double>& stokes) {
  SvgPlot plot(640, 300, {"Stokes number of the approach", 10, 5000, true}, {"rebound over dry rebound", 0, 1.1}, 190);
  std::vector<PlotPoint> curve;
  for (double s = 10; s < 5000; s *= 1.1) curve.push_back({s, wet_rebound(s)});
  plot.line(curve, {"#333", 1.5, ""});
  for (std::size_t n = 0; n < rows.size(); ++n)
    plot.marker({stokes[n], rows[n].ours}, Marker::circle, "#0b6e99", true, fmt::format("{:.3g}", rows[n].ours));
  plot.legend_line("exp(-35/St)", {"#333", 1.5, ""});
  plot.legend_marker("bedload", Marker::circle, "#0b6e99", true);
  return plot.svg();
}

/// The fit is what `wet_restitution` puts in, so that it must come out; the film knows nothing of it, and is held against the
/// experiments that it was fitted to.
Findings wet_bounce(const std::vector<FinishedCase>& runs, const char* figure) {
  Findings found;
  std::vector<double> stokes;
  for (const auto& run : runs) {
    const Trajectory path = trajectory_of(run, 0);
    const double before = -path.velocity.front().z, after = path.velocity.back().z;
    const bool film = run.one.scene.terms.lubrication;
    stokes.push_back(stokes_number(run, before));
    found.rows.push_back({.name = fmt::format("{}: rebound over dry rebound at St = {:.3g} [-]",
                                              film ? "lubrication" : "wet_restitution", stokes.back()),
                          .reference = wet_rebound(stokes.back()),
                          .source = film ? "Legendre et al. 2006, fit to Joseph et al. 2001, Gondret et al. 2002"
                                         : "exp(-35/St), put in",
                          .ours = after / before / run.input("grains.restitution"),
                          .band = Band::within_absolute(film ? 0.1 : 0.02),
                          .against = film ? Against::experiment : Against::equations});
  }
  found.figures.push_back(
      {figure,
       "A steel sphere bounces off a wall in a liquid: speed of the rebound over that of a dry one. Line: "
       "fit by Legendre et al. 2006.",
       bounce_figure(found.rows, stokes)});
  return found;
}

/// Two rows before and after the lowest point: what the flow does to the sphere on its way is left out.
Findings coupled_bounce(const std::vector<FinishedCase>& runs) {
  Findings found;
  std::vector<double> stokes;
  for (const auto& run : runs) {
    const Trajectory path = trajectory_of(run, 0);
    const auto lowest = std::ranges::min_element(path.position, {}, &Vec3::z) - path.position.begin();
    const double before = -path.velocity.at(lowest - 2).z, after = path.velocity.at(lowest + 2).z;
    stokes.push_back(stokes_number(run, before));
    found.rows.push_back({.name = fmt::format("rebound over dry rebound at St = {:.3g}, steps of {:.2g} us [-]",
                                              stokes.back(), 1e6 * run.one.scene.steps.fluid_interval),
                          .reference = wet_rebound(stokes.back()),
                          .source = "Legendre et al. 2006, fit to Joseph et al. 2001, Gondret et al. 2002",
                          .ours = after / before / run.input("grains.restitution"),
                          .band = Band::within_absolute(0.1),
                          .against = Against::experiment});
  }
  found.figures.push_back({"contact-coupled-bounce",
                           "A glass sphere bounces in a liquid, with all terms that the scene requires: speed of the "
                           "rebound over that of a dry one. Line: fit by Legendre et al. 2006.",
                           bounce_figure(found.rows, stokes)});
  return found;
}

// ---- A sphere on a plane

/// Mean acceleration along x over the second half of the run [m/s2]: by then it has come to rest on the plane.
double acceleration(const FinishedCase& run) {
  const Trajectory path = trajectory_of(run, 0);
  const std::size_t last = path.size() - 1, middle = last / 2;
  return (path.velocity[last].x - path.velocity[middle].x) / (path.time[last] - path.time[middle]);
}

Findings incline(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const double slope = run.input("box.slope"), mu = run.input("grains.friction"), g = run.input("box.gravity");
    const bool slides = std::tan(slope) > 3.5 * mu;
    const double exact = slides ? g * (std::sin(slope) - mu * std::cos(slope)) : 5.0 / 7 * g * std::sin(slope);
    found.rows.push_back({.name = fmt::format("acceleration down {:.0f} deg, friction {:.2g}: {} [m/s2]",
                                              degrees(slope), mu, slides ? "slides" : "rolls"),
                          .reference = exact,
                          .source = slides ? "g (sin b - mu cos b)" : "(5/7) g sin b",
                          .ours = acceleration(run),
                          .band = Band::within(0.005)});
  }
  return found;
}

Findings rolling_rest(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const double slope = run.input("box.slope"), mu = run.input("grains.rolling_friction"),
                 g = run.input("box.gravity");
    const Trajectory path = trajectory_of(run, 0);
    const auto where = fmt::format("{:.0f} deg, rolling friction {:.2g}", degrees(slope), mu);
    if (std::tan(slope) < mu)
      found.rows.push_back({.name = fmt::format("way down {}: rests [d]", where),
                            .reference = 0,
                            .source = "rest where tan b < mu_r",
                            .ours = (path.position.back().x - path.position.front().x) / run.input("grains.diameter"),
                            .band = Band::within_absolute(0.001)});
    else
      found.rows.push_back({.name = fmt::format("acceleration down {}: rolls [m/s2]", where),
                            .reference = 5.0 / 7 * g * (std::sin(slope) - mu * std::cos(slope)),
                            .source = "(5/7) g (sin b - mu_r cos b)",
                            .ours = acceleration(run),
                            .band = Band::within(0.005)});
  }
  return found;
}

/// When sliding friction has made the sphere roll: its slip at the plane falls linearly, and is followed from three
/// quarters of its first value to one quarter, and on to zero.
double begins_to_roll(const Trajectory& path, double radius) {
  const auto slip = [&](std::size_t n) { return path.velocity[n].x - radius * path.spin[n].y; };
  const auto below = [&](double fraction) {
    std::size_t n = 0;
    while (n < path.size() && slip(n) > fraction * slip(0)) ++n;
    return n;
  };
  const std::size_t a = below(0.75), b = below(0.25);
  if (b >= path.size() || b == a) return nan;
  return path.time[b] + slip(b) * (path.time[b] - path.time[a]) / (slip(a) - slip(b));
}

Findings rolling_start(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const Trajectory path = trajectory_of(run, 0);
    const double mu = run.input("grains.friction"), g = run.input("box.gravity"), thrown = 0.2;
    found.rows.push_back({.name = fmt::format("speed once it rolls, friction {:.2g} [m/s]", mu),
                          .reference = 5.0 / 7 * thrown,
                          .source = "5/7 v0",
                          .ours = path.velocity.back().x,
                          .band = Band::within(0.005)});
    found.rows.push_back({.name = fmt::format("time until it rolls, friction {:.2g} [ms]", mu),
                          .reference = 1e3 * 2 * thrown / (7 * mu * g),
                          .source = "2 v0/(7 mu g)",
                          .ours = 1e3 * begins_to_roll(path, run.input("grains.diameter") / 2),
                          .band = Band::within(0.005)});
  }
  return found;
}

Findings free_fall(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const Trajectory path = trajectory_of(run, 0);
    found.rows.push_back({.name = fmt::format("speed after {:.3g} ms of free fall [m/s]", 1e3 * path.time.back()),
                          .reference = run.input("box.gravity") * path.time.back(),
                          .source = "Newton: g t",
                          .ours = -path.velocity.back().z,
                          .band = Band::within(1e-10)});
  }
  return found;
}

}   // namespace

std::vector<Rung> contact_rungs() {
  constexpr Material glass{"glass", 0.97, 0.092, 0.44, 0.01, 0.006, 0.07},
      acetate{"acetate", 0.87, 0.25, 0.43, 0.02, 0.02, 0.06};
  return {
      {"contact-free-fall", "a sphere falls in nothing", free_fall, every_case},
      {"contact-hertz", "two equal elastic spheres meet head-on", hertz, every_case},
      {"contact-restitution", "two equal spheres meet head-on with the restitution asked for", restitution, every_case},
      {"contact-foerster-glass", "spheres of soda-lime glass strike a plate at many angles",
       [=](const auto& runs) { return foerster(runs, glass); }, every_case},
      {"contact-foerster-acetate", "spheres of cellulose acetate strike a plate at many angles",
       [=](const auto& runs) { return foerster(runs, acetate); }, every_case},
      {"contact-incline", "a sphere is let go on an incline", incline, every_case},
      {"contact-rolling-rest", "a sphere with rolling friction is let go on an incline", rolling_rest, every_case},
      {"contact-rolling-start", "a sphere is thrown along a plane without spin", rolling_start, every_case},
      {"contact-wet-bounce", "a sphere bounces in a liquid, its restitution chosen by the Stokes number",
       [](const auto& runs) { return wet_bounce(runs, "contact-wet-bounce"); }, every_case},
      {"contact-film-bounce", "a sphere bounces in a liquid, slowed by the film that lubricates the contact",
       [](const auto& runs) { return wet_bounce(runs, "contact-film-bounce"); }, every_case},
      {"contact-coupled-bounce", "a sphere that carries liquid along bounces in it, in short and in long steps",
       coupled_bounce, every_case},
  };
}

}   // namespace bedload
