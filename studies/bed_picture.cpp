// Circles from back to front.
#include "studies/bed_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "studies/svg_plot.hpp"

namespace bedload {

namespace {

constexpr double slowest = 1e-4, fastest = 1;   // ends of the colour scale, in sqrt((s-1) g d)
constexpr double slice_thickness = 5;           // [diameters]
constexpr std::array<Vec3, 5> colours{{{214, 200, 172}, {236, 196, 110}, {238, 139, 62}, {205, 66, 50}, {134, 16, 80}}};
constexpr int sheets = 8;              // of haze between front and back of the slice
constexpr double haze_at_back = 0.6;   // how much of a grain there is lost in it

/// What one sheet covers: as many as `sheets` of them leave 1 - haze_at_back.
double cover_of_a_sheet() { return 1 - std::pow(1 - haze_at_back, 1.0 / sheets); }

/// 0 = slowest or slower, 1 = fastest or faster, logarithmic between.
double place_on_scale(double speed) {
  if (!(speed > slowest)) return 0;
  return std::min(1.0, std::log(speed / slowest) / std::log(fastest / slowest));
}

Vec3 colour_at(double place) {
  const double at = place * (colours.size() - 1);
  const auto n = std::min(static_cast<std::size_t>(at), colours.size() - 2);
  return colours[n] + (at - double(n)) * (colours[n + 1] - colours[n]);
}

std::string hex(Vec3 c) { return fmt::format("#{:02x}{:02x}{:02x}", int(c.x + 0.5), int(c.y + 0.5), int(c.z + 0.5)); }

/// Ids of the grains in the slice, farthest first.
std::vector<std::size_t> slice(const Grains& grains, double depth) {
  std::vector<std::size_t> order;
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (grains.position[p].y <= depth) order.push_back(p);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double ya = grains.position[a].y, yb = grains.position[b].y;
    return ya != yb ? ya > yb : a < b;
  });
  return order;
}

}   // namespace

std::string bed_picture(const BedView& view, double width) {
  const double scale = width / view.length.x, height = view.length.z * scale;   // [px/m]
  const double depth = std::min(view.length.y, slice_thickness * view.diameter);
  const auto sheet =
      fmt::format("<rect width='{:.1f}' height='{:.1f}' fill='var(--water)' opacity='{:.3f}' stroke='none'/>", width,
                  height, cover_of_a_sheet());
  std::string circles;
  int sheets_ahead = sheets;
  for (const std::size_t p : slice(view.grains, depth)) {
    const Vec3 at = view.grains.position[p];
    for (; sheets_ahead > sheets * at.y / depth; --sheets_ahead) circles += circles.empty() ? "" : sheet;
    const Vec3 own = colour_at(place_on_scale(norm(view.grains.velocity[p]) / view.speed_scale));
    const double radius = view.grains.diameter[p] / 2;
    for (const double image : {0.0, view.length.x, -view.length.x}) {   // a grain across the seam shows at both ends
      const double x = at.x + image;
      if (x + radius <= 0 || x - radius >= view.length.x) continue;
      circles += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{:.2f}' fill='{}'/>", x * scale, height - at.z * scale,
                             radius * scale, hex(own));
    }
  }
  const double bar = 5 * view.diameter * scale;
  return fmt::format(
      "<svg class='bed' viewBox='-1 -1 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' style='min-width:{8:.0f}px' "
      "role='img'>"
      "<rect width='{2:.1f}' height='{3:.1f}' fill='var(--water)'/><svg width='{2:.1f}' height='{3:.1f}' "
      "overflow='hidden' "
      "stroke='var(--outline)' stroke-width='0.9'>{4}</svg>"
      "<rect width='{2:.1f}' height='{3:.1f}' fill='none' stroke='var(--frame)'/>"
      "<path d='M14 20h40m-7 -4l7 4l-7 4' stroke='var(--flow)' stroke-width='1.6' fill='none'/><text x='62' y='24' "
      "fill='var(--flow)'>flow</text>"
      "<path d='M{5:.1f} 16v8m0 -4h{6:.1f}m0 -4v8' stroke='var(--dash)' stroke-width='1.3' fill='none'/>"
      "<text x='{7:.1f}' y='38' text-anchor='middle'>5 d</text></svg>",
      width + 2, height + 2, width, height, circles, width - 14 - bar, bar, width - 14 - bar / 2, 0.6 * width);
}

std::string speed_scale_bar() {
  std::string stops, ticks;
  for (int n = 0; n <= 8; ++n)
    stops += fmt::format("<stop offset='{}' stop-color='{}'/>", n / 8.0, hex(colour_at(n / 8.0)));
  constexpr std::array<std::string_view, 5> labels{"≤ 10⁻⁴", "10⁻³", "10⁻²", "0.1", "≥ 1"};
  for (std::size_t n = 0; n < labels.size(); ++n)
    ticks += fmt::format(
        "<path d='M{0:.1f} 14v5' stroke='var(--dash)'/><text x='{0:.1f}' y='31' text-anchor='middle'>{1}</text>",
        24 + 65.0 * double(n), labels[n]);
  return fmt::format(
      "<svg class='bed' viewBox='0 0 330 54' width='330' height='54'><defs><linearGradient "
      "id='speed'>{}</linearGradient></defs>"
      "<rect x='24' y='2' width='260' height='12' fill='url(#speed)' stroke='var(--frame)' stroke-width='0.6'/>{}"
      "<text x='24' y='49'>grain speed / √((s − 1) g d)</text></svg>",
      stops, ticks);
}

}   // namespace bedload
