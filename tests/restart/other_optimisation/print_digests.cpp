// Prints the digest of every step of the tiny runs: linked with the solver compiled at another level of optimisation.
#include <cstdio>

#include "tests/restart/digests_of_a_run.hpp"
#include "tests/restart/tiny_scenes.hpp"

int main() {
  using namespace bedload::test;
  for (const TinyScene& tiny : tiny_scenes())
    for (const std::string& digest : digests_of_a_run(tiny.scene)) std::puts(digest.c_str());
}
