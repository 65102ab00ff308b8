// Comparing settings, and telling what is wrong with them.
#include "studies/setting.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"

namespace bedload {

namespace {

bool equal(const Quantity& a, const Quantity& b) {
  return a.value == b.value && a.dimension == b.dimension && a.diameters == b.diameters &&
         a.grain_times == b.grain_times;
}

}   // namespace

bool same_value(const Setting& a, const Setting& b) {
  if (a.value.index() != b.value.index()) return false;
  return std::visit(
      [&](const auto& left) {
        const auto& right = std::get<std::decay_t<decltype(left)>>(b.value);
        if constexpr (std::is_same_v<std::decay_t<decltype(left)>, Quantity>) return equal(left, right);
        else return left == right;
      },
      a.value);
}

void Problems::add(Place place, std::string message, std::string hint) {
  const auto same = [&](const Problem& p) { return p.message == message; };
  if (std::ranges::any_of(problems_, same)) return;
  problems_.push_back({place, std::move(message), std::move(hint)});
}

void Problems::throw_if_any() const {
  if (problems_.empty()) return;
  auto ordered = problems_;
  std::ranges::stable_sort(ordered, [](const Problem& a, const Problem& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  std::string lines;
  for (const auto& p : ordered) {
    const auto where = p.place.line > 0 ? fmt::format("{}:{}:{}", file_, p.place.line, p.place.column) : file_;
    lines += fmt::format("{}{}: error: {}", lines.empty() ? "" : "\n", where, p.message);
    if (!p.hint.empty()) lines += fmt::format("\nhint: {}", p.hint);
  }
  throw Error(ErrorKind::study_invalid, lines);
}

}   // namespace bedload
