// Fixed small pieces of work whose instructions scripts/instruction_guard counts: contacts, fluid or coupled.
#include <fmt/format.h>

#include <string_view>

#include "benchmarks/reference_scenes.hpp"
#include "solver/state.hpp"

namespace {

/// The tables of self_disturbance are made once, and would be most of so few steps.
bedload::Terms terms_without_tables() {
  bedload::Terms terms = bedload::benchmarks::turbulent_terms();
  terms.self_disturbance = false;
  return terms;
}

}   // namespace

int main(int argc, char** argv) {
  using namespace bedload;
  using namespace bedload::benchmarks;
  const std::string_view name = argc == 2 ? argv[1] : "";
  State state;
  if (name == "contacts") state = collide(loose_bed(test::channel), {}, 100);
  else if (name == "fluid") state = cavity(8);
  else if (name == "coupled") state = sheared_bed(terms_without_tables(), 1e-6, 15);
  else {
    fmt::print(stderr, "usage: instruction_cases contacts|fluid|coupled\n");
    return 64;
  }
  fmt::print("{} {}\n", name, state_digest(state));   // what is printed has to be computed
}
