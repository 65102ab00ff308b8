// Numbers with units, as a person writes them: "0.5 mm", "1.0e-6 m2/s", "20 d". Dimensions are checked.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace bedload {

/// Powers of the base dimensions.
struct Dimension {
  int length = 0, mass = 0, time = 0, angle = 0;
  bool operator==(const Dimension&) const = default;
};

namespace dimension {
inline constexpr Dimension number{};
inline constexpr Dimension length{.length = 1};
inline constexpr Dimension mass{.mass = 1};
inline constexpr Dimension time{.time = 1};
inline constexpr Dimension angle{.angle = 1};
inline constexpr Dimension speed{.length = 1, .time = -1};
inline constexpr Dimension acceleration{.length = 1, .time = -2};
inline constexpr Dimension density{.length = -3, .mass = 1};
inline constexpr Dimension viscosity{.length = 2, .time = -1};   // kinematic
inline constexpr Dimension pressure{.length = -1, .mass = 1, .time = -2};
inline constexpr Dimension pressure_gradient{.length = -2, .mass = 1, .time = -2};
}   // namespace dimension

/// A text that is not the quantity wanted: `"5 s" is a time, not a length`. Where it stood is for the caller to add.
struct UnitError : std::invalid_argument {
  explicit UnitError(const std::string& message, std::string hint_ = {})
      : std::invalid_argument(message), hint(std::move(hint_)) {}
  std::string hint;   // the likely fix; may be empty
};

/// What one "d" (grain diameter) and one "td" (grain time) are, where that is known.
struct GrainScales {
  std::optional<double> diameter;   // [m]
  std::optional<double> time;       // [s]
};

/// A number with its unit, read but not yet measured in grains.
struct Quantity {
  std::string text;      // as written
  double value = 0;      // in SI, per d and per td where these occur
  Dimension dimension;   // with d a length and td a time
  int diameters = 0;     // power of d
  int grain_times = 0;   // power of td

  bool relative() const { return diameters != 0 || grain_times != 0; }
  /// In SI. Throws UnitError when it counts grains and their scale is not given.
  double si(const GrainScales& scales = {}) const;
};

/// Reads "number unit". Units: m g s min h Pa N rad deg % with prefixes n u m c k M G, d and td; joined by spaces, * and /,
/// with powers as in m2, m^2, s-1. A prefix shifts the decimal exponent before the number is read, so "0.2 mm" and
/// "200 um" are the same bits. Throws UnitError unless the result has the dimension wanted; a bare number has not.
Quantity parse_quantity(std::string_view text, Dimension wanted);

/// parse_quantity and si in one.
double read_quantity(std::string_view text, Dimension wanted, const GrainScales& scales = {});

/// "a length", "a kinematic viscosity"; unknown combinations by their base units, "a quantity in m2 kg".
std::string name_of(const Dimension&);

/// The shortest decimal that reads back as the same double.
std::string shortest(double);

}   // namespace bedload
