// A small plot as inline SVG: axes with units, lines, markers, error bars, a legend at its side.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bedload {

/// Text safe between tags and in attributes.
std::string escaped(std::string_view text);

/// A picture in a report takes the page's style; alone in its file it brings its own, light.
std::string standing_alone(const std::string& svg);

struct PlotAxis {
  std::string label;   // with its unit
  double low = 0, high = 1;
  bool logarithmic = false;
  /// Of a vertical axis: rows instead of numbers, the first on top. Row n lies between size - n - 1 and size - n.
  std::vector<std::string> rows = {};
};

struct Stroke {
  std::string_view colour = "var(--text)";
  double width = 1.5;      // [px]
  std::string_view dash;   // of SVG: "4 3"; empty = solid
};

enum class Marker { circle, square, triangle, diamond };

struct PlotPoint {
  double x, y;
};

/// Data coordinates throughout; what lies outside the axes is cut off (lines, areas) or left out (markers).
class SvgPlot {
 public:
  /// Width and height of the whole picture [px], the legend's column included.
  SvgPlot(double width, double height, PlotAxis x, PlotAxis y, double legend_width = 0);

  void shade(PlotPoint from, PlotPoint to, std::string_view colour, double opacity, std::string_view tooltip = {});
  void line(const std::vector<PlotPoint>&, Stroke);
  void vertical_bar(double x, double low, double high, std::string_view colour);   // error bar with caps
  void thin_bar(double x, double low, double high, std::string_view colour);   // beside an error bar: paler, wider caps
  void vertical_arrow(double x, double from, bool upward, std::string_view colour);   // an open bound
  void marker(PlotPoint, Marker, std::string_view colour, bool filled, std::string_view tooltip);
  void note(PlotPoint, std::string_view text, std::string_view colour, std::string_view anchor = "start");

  void legend_heading(std::string_view text);
  void legend_line(std::string_view text, Stroke);
  void legend_shade(std::string_view text, std::string_view colour, double opacity);
  void legend_marker(std::string_view text, Marker, std::string_view colour, bool filled);

  std::string svg() const;

 private:
  double x_of(double x) const;   // [px] from the left of the plotting area
  double y_of(double y) const;   // [px] from its top
  bool inside(PlotPoint) const;
  std::string axes() const;
  void bar(double x, double low, double high, double cap, std::string_view stroke);

  double width_, height_, left_, inner_width_, inner_height_;
  PlotAxis x_, y_;
  double legend_y_ = 6;
  std::string areas_, marks_, legend_;
};

}   // namespace bedload
