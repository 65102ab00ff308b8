// Rows to numbers, then what no bed can be: grains outside, inside each other, without size.
#include "solver/grains/grain_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/grains/box_walls.hpp"
#include "solver/grains/neighbour_search.hpp"

namespace bedload {
namespace {

constexpr std::string_view header = "x,y,z,diameter,density,fixed";
constexpr std::string_view velocity_header = ",vx,vy,vz", spin_header = ",wx,wy,wz";   // may follow: both, either, none
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";   // spreadsheets write it before UTF-8
constexpr double tolerated_overlap = 0.01;                     // of the smaller diameter

/// Collects what is wrong, and says it all at once (or the first few of many).
class Complaints {
 public:
  void add(const std::string& what) {
    if (++count_ > shown) return;
    if (!text_.empty()) text_ += '\n';
    text_ += what;
  }
  void raise(const std::string& hint) const {
    if (count_ == 0) return;
    const std::string more = count_ > shown ? fmt::format("\n... and {} more", count_ - shown) : "";
    throw Error(ErrorKind::study_invalid, text_ + more, hint);
  }

 private:
  static constexpr std::size_t shown = 10;
  std::size_t count_ = 0;
  std::string text_;
};

std::string_view trimmed(std::string_view s) {
  const auto first = s.find_first_not_of(" \t\r"), last = s.find_last_not_of(" \t\r");
  return first == s.npos ? std::string_view{} : s.substr(first, last - first + 1);
}

std::string_view take_until(std::string_view& rest, char stop) {
  const auto end = std::min(rest.find(stop), rest.size());
  const std::string_view head = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return trimmed(head);
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Values of a row; those of columns that the table has not are zero.
using Values = std::array<double, 12>;

/// The places in Values of a table's columns; nothing if its first line is no header.
std::optional<std::vector<std::size_t>> places_of(std::string_view columns) {
  std::vector<std::size_t> places;
  std::size_t next = 0;
  for (const std::string_view part : {header, velocity_header, spin_header}) {
    const std::size_t many = part == header ? 6 : 3;
    if (columns.starts_with(part)) {
      columns.remove_prefix(part.size());
      for (std::size_t n = 0; n < many; ++n) places.push_back(next + n);
    } else if (part == header) {
      return std::nullopt;
    }
    next += many;
  }
  if (!columns.empty()) return std::nullopt;
  return places;
}

std::optional<Values> numbers(std::string_view line, std::string_view columns, std::span<const std::size_t> places,
                              std::size_t row, Complaints& complaints) {
  const auto found = static_cast<std::size_t>(std::ranges::count(line, ',')) + 1;
  if (found != places.size()) {
    complaints.add(fmt::format("row {}: {} columns where {} are due", row, found, columns));
    return std::nullopt;
  }
  Values values{};
  for (const std::size_t place : places) {
    const std::string_view name = take_until(columns, ','), text = take_until(line, ',');
    const auto read = number(text);
    if (!read) {
      complaints.add(fmt::format("row {}: {} = \"{}\" is not a number", row, name, text));
      return std::nullopt;
    }
    values[place] = *read;
  }
  return values;
}

void check_row(const BedScene& scene, const Values& v, std::size_t row, Complaints& complaints) {
  const auto [x, y, z, diameter, density, fixed, vx, vy, vz, wx, wy, wz] = v;
  if (!(diameter > 0)) complaints.add(fmt::format("row {}: diameter = {} m is not positive", row, diameter));
  if (!(density > 0)) complaints.add(fmt::format("row {}: density = {} kg/m3 is not positive", row, density));
  if (fixed != 0 && fixed != 1) complaints.add(fmt::format("row {}: fixed = {} is neither 0 nor 1", row, fixed));
  if (fixed == 1 && (norm2({vx, vy, vz}) > 0 || norm2({wx, wy, wz}) > 0))
    complaints.add(fmt::format("row {}: a fixed grain has a velocity or a spin", row));
  const PeriodicBox box(scene);
  for (int c = 0; c < 3; ++c) {
    // A fixed grain may stand half in a wall: rough bottoms are made so.
    const double room = box.periodic(c) || fixed == 1 ? 0 : diameter * (0.5 - tolerated_overlap);
    if (v[c] < room || v[c] > box.length[c] - room)
      complaints.add(fmt::format("row {}: the grain at {} = {} m of diameter {} m is outside the box (0 to {} m)", row,
                                 "xyz"[c], v[c], diameter, box.length[c]));
  }
}

void check_overlaps(const BedScene& scene, const Grains& grains, const std::vector<std::size_t>& row,
                    Complaints& complaints) {
  const PeriodicBox box(scene);
  check_periodic_sides(box, *std::ranges::max_element(grains.diameter));
  std::vector<double> radius(grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i) radius[i] = 0.5 * grains.diameter[i];
  PairList pairs;
  find_near_pairs(box, grains.position, radius, {}, pairs);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto i = pairs.lower[k], j = pairs.higher[k];
    const double smaller = std::min(grains.diameter[i], grains.diameter[j]);
    const double distance = norm(box.shortest(grains.position[j] - grains.position[i]));
    const double overlap = radius[i] + radius[j] - distance;
    if (distance < 1e-9 * smaller)
      complaints.add(fmt::format("rows {} and {}: two grains at one place", row[i], row[j]));
    else if (overlap > tolerated_overlap * smaller)
      complaints.add(fmt::format(
          "rows {} and {}: the grains overlap by {:.3g} m, {:.3g} % of a diameter; at most {} % is accepted", row[i],
          row[j], overlap, 100 * overlap / smaller, 100 * tolerated_overlap));
  }
}

}   // namespace

Grains read_grain_table(const BedScene& scene) {
  std::string_view rest = scene.source.csv;
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  Complaints complaints;
  const std::string_view columns = take_until(rest, '\n');
  const auto places = places_of(columns);
  if (!places)
    throw Error(ErrorKind::study_invalid, fmt::format("row 1: the header is \"{}\", not \"{}\"", columns, header),
                "the first line names the columns, in this order; vx,vy,vz and wx,wy,wz may follow; all values are in "
                "SI units");
  if (rest.find_first_not_of(" \t\r\n") == rest.npos)
    throw Error(ErrorKind::study_invalid, "the table has a header and no grains",
                "add rows; bed.source = \"none\" is a box without grains");
  Grains grains;
  std::vector<std::size_t> row_of;
  for (std::size_t row = 2; !rest.empty(); ++row) {
    const std::string_view line = take_until(rest, '\n');
    if (line.empty()) continue;
    const auto values = numbers(line, columns, *places, row, complaints);
    if (!values) continue;
    check_row(scene, *values, row, complaints);
    const auto [x, y, z, diameter, density, fixed, vx, vy, vz, wx, wy, wz] = *values;
    grains.position.push_back(PeriodicBox(scene).wrapped({x, y, z}));
    grains.velocity.push_back({vx, vy, vz});
    grains.spin.push_back({wx, wy, wz});
    grains.diameter.push_back(diameter);
    grains.density.push_back(density);
    grains.fixed.push_back(fixed == 1);
    row_of.push_back(row);
  }
  complaints.raise(fmt::format("columns are {} in SI units", columns));
  grains.resize(grains.size());   // the rest: zero
  check_overlaps(scene, grains, row_of, complaints);
  complaints.raise("settle the bed before it is written, or thin it out");
  return grains;
}

}   // namespace bedload
