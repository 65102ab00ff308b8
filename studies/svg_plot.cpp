// Scales, ticks and shapes.
#include "studies/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "studies/theme.hpp"

namespace bedload {

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) switch (c) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '"': safe += "&quot;"; break;
      default: safe += c;
    }
  return safe;
}

namespace {

constexpr double least_left = 70, most_left = 270, right = 14, top = 10, bottom = 46;   // margins [px]
constexpr double letter = 7.6;   // width of one, at most on the mean [px]
constexpr double legend_step = 18;
constexpr double least_scale = 0.85;   // a page narrower than that scrolls: letters of 10 px can still be read

double position(const PlotAxis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return std::log(value / axis.low) / std::log(axis.high / axis.low);
}

struct Tick {
  double value;
  bool labelled;
};

/// Decades, the steps between them where there is room, and labels at 2 and 5 where decades are few.
std::vector<Tick> logarithmic_ticks(const PlotAxis& axis, double pixels) {
  const double decades = std::log10(axis.high / axis.low);
  const int step = pixels / decades > 70 ? 1 : 9;
  std::vector<Tick> ticks;
  for (int e = int(std::floor(std::log10(axis.low) + 1e-9)); e <= std::ceil(std::log10(axis.high)); ++e)
    for (int m = 1; m < 10; m += step) {
      const double value = m * std::pow(10, e);
      if (value < axis.low * (1 - 1e-9) || value > axis.high * (1 + 1e-9)) continue;
      ticks.push_back({value, m == 1 || (decades < 2.2 && (m == 2 || m == 5))});
    }
  return ticks;
}

std::vector<Tick> linear_ticks(const PlotAxis& axis) {
  const double raw = (axis.high - axis.low) / 5, power = std::pow(10, std::floor(std::log10(raw)));
  const double step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
  std::vector<Tick> ticks;
  for (double n = std::ceil(axis.low / step - 1e-9); n * step <= axis.high + 1e-9 * step; ++n)
    ticks.push_back({n * step, true});
  return ticks;
}

std::vector<Tick> ticks_of(const PlotAxis& axis, double pixels) {
  return axis.logarithmic ? logarithmic_ticks(axis, pixels) : linear_ticks(axis);
}

/// 0.02, 1, 500, but a power of ten where zeros would have to be counted.
std::string tick_text(const PlotAxis& axis, double value) {
  const int exponent = value > 0 ? int(std::lround(std::log10(value))) : 0;
  if (!axis.logarithmic || std::abs(exponent) <= 3) return fmt::format("{:.4g}", std::abs(value) < 1e-12 ? 0 : value);
  constexpr std::array<std::string_view, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  return fmt::format("10{}{}", exponent < 0 ? "⁻" : "", digits[std::size_t(std::abs(exponent) % 10)]);
}

std::string dashes(std::string_view dash) { return dash.empty() ? "" : fmt::format(" stroke-dasharray='{}'", dash); }

std::string marker_shape(double x, double y, Marker shape, std::string_view colour, bool filled) {
  const std::string style =
      fmt::format("fill='{}' stroke='{}' stroke-width='1.8'", filled ? colour : "var(--paper)", colour);
  switch (shape) {
    case Marker::circle: return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='4.6' {}", x, y, style);
    case Marker::square:
      return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='8.4' height='8.4' {}", x - 4.2, y - 4.2, style);
    case Marker::triangle: return fmt::format("<path d='M{:.1f} {:.1f}l5.4 9.4h-10.8z' {}", x, y - 6, style);
    case Marker::diamond:
      return fmt::format("<path d='M{:.1f} {:.1f}l5.6 5.6l-5.6 5.6l-5.6 -5.6z' {}", x, y - 5.6, style);
  }
  return {};
}

}   // namespace

namespace {

double left_of(const PlotAxis& y) {
  double left = least_left;
  for (const std::string& row : y.rows) left = std::max(left, letter * double(row.size()) + 12);
  return std::min(left, most_left);   // of a longer label the picture shows the end
}

}   // namespace

SvgPlot::SvgPlot(double width, double height, PlotAxis x, PlotAxis y, double legend_width)
    : width_(width),
      height_(height),
      left_(left_of(y)),
      inner_width_(width - left_ - right - legend_width),
      inner_height_(height - top - bottom),
      x_(std::move(x)),
      y_(std::move(y)) {}

double SvgPlot::x_of(double x) const { return position(x_, x) * inner_width_; }
double SvgPlot::y_of(double y) const { return (1 - position(y_, y)) * inner_height_; }

bool SvgPlot::inside(PlotPoint p) const {
  const double x = position(x_, p.x), y = position(y_, p.y);
  return x >= -1e-9 && x <= 1 + 1e-9 && y >= -1e-9 && y <= 1 + 1e-9;
}

void SvgPlot::shade(PlotPoint from, PlotPoint to, std::string_view colour, double opacity, std::string_view tooltip) {
  const double x = x_of(from.x), y = y_of(to.y);
  areas_ += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}' opacity='{}'", x, y,
                        x_of(to.x) - x, y_of(from.y) - y, colour, opacity);
  areas_ += tooltip.empty() ? "/>" : fmt::format("><title>{}</title></rect>", escaped(tooltip));
}

void SvgPlot::line(const std::vector<PlotPoint>& points, Stroke stroke) {
  std::string path;
  for (const PlotPoint p : points)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x_of(p.x), y_of(p.y));
  areas_ += fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='{}' stroke-linejoin='round'{}/>", path,
                        stroke.colour, stroke.width, dashes(stroke.dash));
}

void SvgPlot::bar(double x, double low, double high, double cap, std::string_view stroke) {
  const double at = x_of(x), from = std::clamp(y_of(low), 0.0, inner_height_),
               to = std::clamp(y_of(high), 0.0, inner_height_);
  if (at < 0 || at > inner_width_) return;
  marks_ += fmt::format(
      "<path d='M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h{4:.0f}M{3:.1f} {2:.1f}h{4:.0f}' {5} fill='none'/>", at, from,
      to, at - cap, 2 * cap, stroke);
}

void SvgPlot::vertical_bar(double x, double low, double high, std::string_view colour) {
  bar(x, low, high, 4, fmt::format("stroke='{}' stroke-width='1.4'", colour));
}

void SvgPlot::thin_bar(double x, double low, double high, std::string_view colour) {
  bar(x, low, high, 8, fmt::format("stroke='{}' stroke-width='1' stroke-opacity='0.7'", colour));
}

void SvgPlot::vertical_arrow(double x, double from, bool upward, std::string_view colour) {
  if (!inside({x, from})) return;
  const double sign = upward ? -1 : 1, tip = y_of(from) + 26 * sign;
  marks_ += fmt::format(
      "<path d='M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {4:.1f}L{0:.1f} {2:.1f}L{5:.1f} {4:.1f}' stroke='{6}' "
      "stroke-width='1.6' fill='none'/>",
      x_of(x), y_of(from), tip, x_of(x) - 4, tip - 6 * sign, x_of(x) + 4, colour);
}

void SvgPlot::marker(PlotPoint at, Marker shape, std::string_view colour, bool filled, std::string_view tooltip) {
  if (!inside(at)) return;
  marks_ += marker_shape(x_of(at.x), y_of(at.y), shape, colour, filled) +
            fmt::format("><title>{}</title></{}>", escaped(tooltip),
                        shape == Marker::circle   ? "circle"
                        : shape == Marker::square ? "rect"
                                                  : "path");
}

void SvgPlot::note(PlotPoint at, std::string_view text, std::string_view colour, std::string_view anchor) {
  if (!inside(at)) return;
  marks_ += fmt::format("<text x='{:.1f}' y='{:.1f}' fill='{}' text-anchor='{}' class='note'>{}</text>", x_of(at.x),
                        y_of(at.y), colour, anchor, escaped(text));
}

void SvgPlot::legend_heading(std::string_view text) {
  if (!legend_.empty()) legend_y_ += 8;
  legend_ += fmt::format("<text x='0' y='{:.1f}' class='heading'>{}</text>", legend_y_ + 4, escaped(text));
  legend_y_ += legend_step;
}

void SvgPlot::legend_line(std::string_view text, Stroke stroke) {
  legend_ +=
      fmt::format("<path d='M0 {0:.1f}h26' stroke='{1}' stroke-width='{2}'{3}/><text x='34' y='{4:.1f}'>{5}</text>",
                  legend_y_, stroke.colour, stroke.width, dashes(stroke.dash), legend_y_ + 4, escaped(text));
  legend_y_ += legend_step;
}

void SvgPlot::legend_shade(std::string_view text, std::string_view colour, double opacity) {
  legend_ += fmt::format(
      "<rect x='0' y='{:.1f}' width='26' height='11' fill='{}' opacity='{}'/><text x='34' y='{:.1f}'>{}</text>",
      legend_y_ - 5.5, colour, opacity, legend_y_ + 4, escaped(text));
  legend_y_ += legend_step;
}

void SvgPlot::legend_marker(std::string_view text, Marker shape, std::string_view colour, bool filled) {
  legend_ += marker_shape(13, legend_y_, shape, colour, filled) +
             fmt::format("/><text x='34' y='{:.1f}'>{}</text>", legend_y_ + 4, escaped(text));
  legend_y_ += legend_step;
}

std::string SvgPlot::axes() const {
  std::string grid, labels;
  for (const Tick& tick : ticks_of(x_, inner_width_)) {
    const double x = x_of(tick.value);
    grid += fmt::format("<path d='M{:.1f} 0V{:.1f}' class='{}'/>", x, inner_height_, tick.labelled ? "grid" : "fine");
    if (tick.labelled)
      labels += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>", x, inner_height_ + 17,
                            tick_text(x_, tick.value));
  }
  for (std::size_t n = 0; n < y_.rows.size(); ++n)
    if (!y_.rows[n].empty())
      labels += fmt::format("<text x='-7' y='{:.1f}' text-anchor='end'>{}</text>",
                            y_of(double(y_.rows.size() - n) - 0.5) + 4, escaped(y_.rows[n]));
  if (y_.rows.empty())
    for (const Tick& tick : ticks_of(y_, inner_height_)) {
      const double y = y_of(tick.value);
      grid += fmt::format("<path d='M0 {:.1f}H{:.1f}' class='{}'/>", y, inner_width_, tick.labelled ? "grid" : "fine");
      if (tick.labelled)
        labels += fmt::format("<text x='-7' y='{:.1f}' text-anchor='end'>{}</text>", y + 4, tick_text(y_, tick.value));
    }
  labels += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle' class='axis'>{}</text>", inner_width_ / 2,
                        inner_height_ + 38, escaped(x_.label));
  if (!y_.label.empty())
    labels +=
        fmt::format("<text transform='translate(-53 {:.1f}) rotate(-90)' text-anchor='middle' class='axis'>{}</text>",
                    inner_height_ / 2, escaped(y_.label));
  return grid + labels;
}

std::string SvgPlot::svg() const {
  return fmt::format(
      "<svg class='plot' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' "
      "style='min-width:{11:.0f}px' role='img'>"
      "<g transform='translate({2} {3})'>{4}<svg width='{5:.1f}' height='{6:.1f}' overflow='hidden'>{7}</svg>"
      "<rect width='{5:.1f}' height='{6:.1f}' class='frame'/>{8}<g transform='translate({9:.1f} 0)'>{10}</g></g></svg>",
      width_, height_, left_, top, axes(), inner_width_, inner_height_, areas_, marks_, inner_width_ + 22, legend_,
      least_scale * width_);
}

std::string standing_alone(const std::string& svg) {
  constexpr std::string_view style =
      "<style>svg{font:12px 'Liberation Sans','DejaVu Sans',sans-serif;fill:var(--text);background:var(--paper)}"
      ".grid{stroke:var(--grid)}.fine{stroke:var(--fine)}.frame{fill:none;stroke:var(--frame)}"
      ".axis{font-size:13px;fill:var(--ink)}.heading{font-weight:600;fill:var(--ink)}</style>";
  constexpr std::string_view opening = "<svg ";
  const auto end = svg.find('>');
  if (!svg.starts_with(opening) || end == svg.npos) return svg;
  return in_light_colours(fmt::format("<svg xmlns='http://www.w3.org/2000/svg' {}{}{}\n",
                                      svg.substr(opening.size(), end + 1 - opening.size()), style,
                                      svg.substr(end + 1)));
}

}   // namespace bedload
