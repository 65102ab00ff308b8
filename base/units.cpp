// Reading a number and its unit; every unit is a dimension, a power of ten and a factor.
#include "base/units.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace bedload {

namespace {

struct Unit {
  Dimension dimension;
  int decimal = 0;     // power of ten to SI
  double factor = 1;   // what no power of ten can say
  int diameters = 0, grain_times = 0;
};

struct NamedUnit {
  std::string_view symbol;
  Unit unit;
  bool takes_prefix;
};

constexpr std::array<NamedUnit, 12> units{{
    {"m", {.dimension = dimension::length}, true},
    {"g", {.dimension = dimension::mass, .decimal = -3}, true},
    {"s", {.dimension = dimension::time}, true},
    {"min", {.dimension = dimension::time, .factor = 60}, false},
    {"h", {.dimension = dimension::time, .factor = 3600}, false},
    {"Pa", {.dimension = dimension::pressure}, true},
    {"N", {.dimension = {.length = 1, .mass = 1, .time = -2}}, true},
    {"rad", {.dimension = dimension::angle}, true},
    {"deg", {.dimension = dimension::angle, .factor = std::numbers::pi / 180}, false},
    {"%", {.decimal = -2}, false},
    {"d", {.dimension = dimension::length, .diameters = 1}, false},
    {"td", {.dimension = dimension::time, .grain_times = 1}, false},
}};

struct Prefix {
  std::string_view symbol;
  int decimal;
};
constexpr std::array<Prefix, 9> prefixes{
    {{"n", -9}, {"u", -6}, {"\u00b5", -6}, {"\u03bc", -6}, {"m", -3}, {"c", -2}, {"k", 3}, {"M", 6}, {"G", 9}}};

struct NamedDimension {
  Dimension dimension;
  std::string_view name, example;
};
constexpr std::array<NamedDimension, 15> named_dimensions{{
    {dimension::number, "a number without unit", "0.5"},
    {dimension::length, "a length", "0.5 mm"},
    {dimension::mass, "a mass", "1 g"},
    {dimension::time, "a time", "0.2 s"},
    {dimension::angle, "an angle", "2 deg"},
    {dimension::speed, "a speed", "0.1 m/s"},
    {dimension::acceleration, "an acceleration", "9.81 m/s2"},
    {dimension::density, "a density", "2650 kg/m3"},
    {dimension::viscosity, "a kinematic viscosity", "1.0e-6 m2/s"},
    {dimension::pressure, "a pressure", "1.2e7 Pa"},
    {dimension::pressure_gradient, "a pressure gradient", "10 Pa/m"},
    {{.length = -1, .mass = 1, .time = -1}, "a dynamic viscosity", "1.0e-3 Pa s"},
    {{.length = 1, .mass = 1, .time = -2}, "a force", "1 N"},
    {{.length = 2}, "an area", "1 m2"},
    {{.length = 3}, "a volume", "1 m3"},
}};

const NamedDimension* find_name(const Dimension& d) {
  const auto found = std::ranges::find(named_dimensions, d, &NamedDimension::dimension);
  return found == named_dimensions.end() ? nullptr : &*found;
}

std::string example_of(const Dimension& d) {
  const auto* named = find_name(d);
  return named ? fmt::format("for example \"{}\"", named->example) : std::string();
}

std::optional<Unit> find_unit(std::string_view symbol) {
  if (const auto exact = std::ranges::find(units, symbol, &NamedUnit::symbol); exact != units.end()) return exact->unit;
  for (const auto& prefix : prefixes) {
    if (!symbol.starts_with(prefix.symbol)) continue;
    const auto found = std::ranges::find(units, symbol.substr(prefix.symbol.size()), &NamedUnit::symbol);
    if (found == units.end() || !found->takes_prefix) continue;
    Unit unit = found->unit;
    unit.decimal += prefix.decimal;
    return unit;
  }
  return std::nullopt;
}

double power_of(double base, int power) {
  double result = 1;
  for (int n = 0; n < std::abs(power); ++n) result *= base;
  return power < 0 ? 1 / result : result;
}

void multiply(Unit& product, const Unit& unit, int power) {
  product.dimension.length += power * unit.dimension.length;
  product.dimension.mass += power * unit.dimension.mass;
  product.dimension.time += power * unit.dimension.time;
  product.dimension.angle += power * unit.dimension.angle;
  product.decimal += power * unit.decimal;
  product.diameters += power * unit.diameters;
  product.grain_times += power * unit.grain_times;
  product.factor *= power_of(unit.factor, power);
}

/// The power behind a symbol in "m2", "m^2", "s-1"; 1 if there is none; nothing if it is no small whole number.
std::optional<int> read_power(std::string_view digits) {
  if (digits.starts_with('^')) digits.remove_prefix(1);
  else if (digits.empty()) return 1;
  int power = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), power);
  const bool whole = problem == std::errc() && end == digits.data() + digits.size();
  return whole && power != 0 && std::abs(power) <= 9 ? std::optional(power) : std::nullopt;
}

/// The unit that one word such as "mm" or "s-2" stands for, multiplied into a product to the power `sign` times its own.
void multiply_word(Unit& product, std::string_view word, int sign, const std::string& complaint) {
  const auto letters = std::min(word.find_first_of("^-+0123456789"), word.size());
  const auto unit = find_unit(word.substr(0, letters));
  const auto power = read_power(word.substr(letters));
  if (!unit || !power) {
    throw UnitError(
        fmt::format("{}: \"{}\" is not a unit", complaint, word.empty() ? "/" : word),
        "units are m g s min h Pa N rad deg % with prefixes n u m c k M G; d and td count grain diameters and "
        "grain times");
  }
  multiply(product, *unit, sign * *power);
}

/// Words joined by spaces and *, at most the last of them behind a /: "kg/m s2" could be read in two ways.
Unit parse_unit(std::string_view text, const std::string& complaint) {
  Unit product;
  for (int sign = 1; !text.empty();) {
    if (sign < 0) {
      throw UnitError(complaint + ": its unit can be read in two ways", "write powers instead, as in \"kg m-1 s-2\"");
    }
    const auto separators = std::min(text.find_first_not_of(" */"), text.size());
    if (text.substr(0, separators).find('/') != text.npos) sign = -1;
    text.remove_prefix(separators);
    const auto end = std::min(text.find_first_of(" */"), text.size());
    multiply_word(product, text.substr(0, end), sign, complaint);
    text.remove_prefix(end);
  }
  return product;
}

/// Length of the leading "12", "-1.0e-6"; 0 if the text does not begin with a number.
std::size_t number_length(std::string_view text) {
  double ignored;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), ignored);
  const bool digits = text.find_first_of("0123456789") < static_cast<std::size_t>(end - text.data());   // not inf, nan
  return problem != std::errc::invalid_argument && digits ? static_cast<std::size_t>(end - text.data()) : 0;
}

/// The double nearest to number * 10^shift: the shift is added to the exponent before the digits are read, so there is one
/// rounding, whatever the prefix.
std::optional<double> read_shifted(std::string_view number, int shift) {
  int exponent = 0;
  if (const auto e = number.find_first_of("eE"); e != number.npos) {
    auto digits = number.substr(e + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    number = number.substr(0, e);
  }
  const std::string shifted = fmt::format("{}e{}", number, exponent + shift);
  double value = 0;
  const auto [end, problem] = std::from_chars(shifted.data(), shifted.data() + shifted.size(), value);
  if (problem != std::errc()) return std::nullopt;
  return value;
}

/// A unit may touch its number ("5mm"); a comma or a second point shows a number written in another way.
bool may_follow_number(std::string_view rest) {
  return rest.empty() || rest[0] == ' ' || rest[0] == '%' || std::isalpha(static_cast<unsigned char>(rest[0])) ||
         (rest[0] & 0x80) != 0;
}

std::string_view trimmed(std::string_view text) {
  const auto first = std::min(text.find_first_not_of(' '), text.size());
  text.remove_prefix(first);
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

std::string comma_hint(std::string_view text, const Dimension& wanted) {
  const auto comma = text.find(',');
  if (comma == text.npos) return example_of(wanted);
  std::string corrected(text);
  corrected[comma] = '.';
  return fmt::format("the decimal sign is a point: \"{}\"", corrected);
}

void check_dimension(std::string_view text, const Unit& unit, const Dimension& wanted) {
  if (unit.dimension == wanted) return;
  if (unit.dimension == dimension::number) {
    throw UnitError(fmt::format("\"{}\" has no unit, and {} is wanted", text, name_of(wanted)), example_of(wanted));
  }
  throw UnitError(fmt::format("\"{}\" is {}, not {}", text, name_of(unit.dimension), name_of(wanted)),
                  example_of(wanted));
}

}   // namespace

Quantity parse_quantity(std::string_view text, Dimension wanted) {
  const std::string complaint = fmt::format("\"{}\" is not {}", text, name_of(wanted));
  const auto body = trimmed(text);
  const auto length = number_length(body);
  if (length == 0 || !may_follow_number(body.substr(length))) throw UnitError(complaint, comma_hint(body, wanted));
  const Unit unit = parse_unit(trimmed(body.substr(length)), complaint);
  check_dimension(text, unit, wanted);
  const auto value = read_shifted(body.substr(0, length), unit.decimal);
  if (!value) throw UnitError(complaint + ": too large or too small for a double");
  return {.text = std::string(text),
          .value = *value * unit.factor,
          .dimension = unit.dimension,
          .diameters = unit.diameters,
          .grain_times = unit.grain_times};
}

double Quantity::si(const GrainScales& scales) const {
  if (diameters != 0 && !scales.diameter) {
    throw UnitError(fmt::format("\"{}\" counts grain diameters, which are not known here", text),
                    example_of(dimension));
  }
  if (grain_times != 0 && !scales.time) {
    throw UnitError(fmt::format("\"{}\" counts grain times, which are not known here", text), example_of(dimension));
  }
  return value * power_of(scales.diameter.value_or(1), diameters) * power_of(scales.time.value_or(1), grain_times);
}

double read_quantity(std::string_view text, Dimension wanted, const GrainScales& scales) {
  return parse_quantity(text, wanted).si(scales);
}

std::string name_of(const Dimension& d) {
  if (const auto* named = find_name(d)) return std::string(named->name);
  std::string units_text;
  for (const auto& [symbol, power] : {std::pair{"m", d.length}, {"kg", d.mass}, {"s", d.time}, {"rad", d.angle}}) {
    if (power == 1) units_text += fmt::format(" {}", symbol);
    if (power != 0 && power != 1) units_text += fmt::format(" {}{}", symbol, power);
  }
  return "a quantity in" + units_text;
}

std::string shortest(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}   // namespace bedload
