#include "solver/coupling/drag_laws.hpp"

namespace bedload {

DragLaw drag_law(DragLawName name) {
  switch (name) {
    case DragLawName::stokes: return Stokes{};
    case DragLawName::schiller_naumann: return SchillerNaumann{};
    case DragLawName::di_felice: return DiFelice{};
    case DragLawName::ergun: return Ergun{};
    case DragLawName::gidaspow: return Gidaspow{};
    case DragLawName::koch_hill: return KochHill{};
    case DragLawName::beetstra: return Beetstra{};
    case DragLawName::tang: return Tang{};
    case DragLawName::rong: return Rong{};
  }
  return DiFelice{};
}

std::string_view name_of(DragLawName name) {
  switch (name) {
    case DragLawName::stokes: return "stokes";
    case DragLawName::schiller_naumann: return "schiller_naumann";
    case DragLawName::di_felice: return "di_felice";
    case DragLawName::ergun: return "ergun";
    case DragLawName::gidaspow: return "gidaspow";
    case DragLawName::koch_hill: return "koch_hill";
    case DragLawName::beetstra: return "beetstra";
    case DragLawName::tang: return "tang";
    case DragLawName::rong: return "rong";
  }
  return "di_felice";
}

DragRange range_of(DragLawName name) {
  return std::visit([](const auto& law) { return law.range; }, drag_law(name));
}

double terminal_speed(DragLawName name, double viscosity, double density_ratio, double diameter, double gravity) {
  const bool lone = range_of(name).highest_void == 1;
  const DragLaw law = drag_law(lone ? name : DragLawName::schiller_naumann);
  const double stokes = std::abs(density_ratio - 1) * gravity * diameter * diameter / (18 * viscosity);
  const auto excess = [&](double speed) {
    const double f = std::visit([&](const auto& l) { return l.multiplier(1, speed * diameter / viscosity); }, law);
    return f * speed - stokes;
  };
  double low = 0, high = 2 * stokes;   // every law for lone grains is above half of Stokes' drag and grows with speed
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return middle;
    (excess(middle) < 0 ? low : high) = middle;
  }
}

}   // namespace bedload
