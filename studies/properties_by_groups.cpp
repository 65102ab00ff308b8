#include "studies/properties_by_groups.hpp"

#include <cmath>

#include "solver/dimensionless.hpp"

namespace bedload {

namespace {

constexpr int picked_digits = 6;   // of a diameter or a viscosity: Ga comes out within 1e-5

void take_density(InputList& list) {
  if (!list.given("grains.density_ratio")) return list.take("grains.density");
  if (list.given("grains.density"))
    return list.problem("grains.density_ratio", "grains.density is given too, and with fluid.density says it already",
                        "leave out grains.density or grains.density_ratio");
  if (!list.inputs.has("fluid.density")) return;
  list.take("grains.density_ratio");
  const double density = list.number("grains.density_ratio") * list.number("fluid.density");
  list.inputs.values.erase("grains.density_ratio");
  list.inputs.values["grains.density"] = significant(density, exact_digits);
}

/// (|s-1| g)^(1/2) of the case [m^(1/2)/s]; 0 while it is not known.
double root_of_weight(InputList& list) {
  for (const auto key : {"fluid.density", "grains.density", "box.gravity"})
    if (!list.inputs.has(key)) return 0;
  const double s = list.number("grains.density") / list.number("fluid.density");
  const double weight = reduced_gravity(s, list.number("box.gravity"));
  if (weight == 0)
    list.problem("fluid.galileo", "grains without submerged weight have a Galileo number of zero",
                 "give grains.diameter and fluid.viscosity instead");
  return std::sqrt(weight);
}

void pick_by_galileo(InputList& list, bool has_diameter) {
  list.take(has_diameter ? "grains.diameter" : "fluid.viscosity");
  list.take("fluid.galileo");
  const double root = root_of_weight(list), galileo = list.number("fluid.galileo");
  list.inputs.values.erase("fluid.galileo");
  if (root == 0) return;
  if (has_diameter) {
    if (!list.inputs.has("grains.diameter")) return;
    const double d = list.number("grains.diameter");
    list.inputs.values["fluid.viscosity"] = significant(root * d * std::sqrt(d) / galileo, picked_digits);
  } else {
    const double root_of_cube = galileo * list.number("fluid.viscosity") / root;   // d^(3/2)
    list.inputs.values["grains.diameter"] = significant(std::cbrt(root_of_cube * root_of_cube), picked_digits);
  }
}

void take_diameter_and_viscosity(InputList& list) {
  const bool has_diameter = list.given("grains.diameter"), has_viscosity = list.given("fluid.viscosity");
  if (!list.given("fluid.galileo")) return list.take_all({"fluid.viscosity", "grains.diameter"});
  if (has_diameter && has_viscosity)
    return list.problem("fluid.galileo", "grains.diameter and fluid.viscosity are given too, and say it already",
                        "leave out one of fluid.galileo, grains.diameter and fluid.viscosity");
  if (!has_diameter && !has_viscosity)
    return list.problem("fluid.galileo", "neither grains.diameter nor fluid.viscosity is given, and it stands for one",
                        "give one of them: diameter = \"0.5 mm\", or viscosity = \"1e-5 m2/s\"");
  pick_by_galileo(list, has_diameter);
}

}   // namespace

void take_properties(InputList& list) {
  take_density(list);
  take_diameter_and_viscosity(list);
}

}   // namespace bedload
