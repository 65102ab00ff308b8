#include "solver/coupling/drag_laws.hpp"

namespace bedload {

DragLaw drag_law(DragLawName name) {
  switch (name) {
    case DragLawName::stokes: return Stokes{};
    case DragLawName::schiller_naumann: return SchillerNaumann{};
    case DragLawName::di_felice: return DiFelice{};
  }
  return DiFelice{};
}

std::string_view name_of(DragLawName name) {
  switch (name) {
    case DragLawName::stokes: return "stokes";
    case DragLawName::schiller_naumann: return "schiller_naumann";
    case DragLawName::di_felice: return "di_felice";
  }
  return "di_felice";
}

double terminal_speed(DragLawName name, double viscosity, double density_ratio, double diameter, double gravity) {
  const DragLaw law = drag_law(name);
  const double stokes = std::abs(density_ratio - 1) * gravity * diameter * diameter / (18 * viscosity);
  const auto excess = [&](double speed) {
    const double f = std::visit([&](const auto& l) { return l.multiplier(1, speed * diameter / viscosity); }, law);
    return f * speed - stokes;
  };
  double low = 0, high = 2 * stokes;   // every law is above half of Stokes' drag and grows with speed
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return middle;
    (excess(middle) < 0 ? low : high) = middle;
  }
}

}   // namespace bedload
