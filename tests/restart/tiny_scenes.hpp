// Beds of a hundred grains under a short ramp: small enough to run many times, and everything a run does happens in them.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "solver/scene.hpp"

namespace bedload::test {

struct TinyScene {
  std::string name;
  Scene scene;
};
inline void PrintTo(const TinyScene& tiny, std::ostream* out) { *out << tiny.name; }

/// Poured, then sheared by a lid, from rest to grains on the move.
TinyScene lid_driven();
/// Grains of many sizes between side walls on a slope, driven by a gradient under a free surface; terms of Model B.
TinyScene stream_on_a_slope();
/// Grains of a table, two of them fixed, sinking in a box without walls.
TinyScene suspension();

/// A syrup pressed up and down through a layer of fixed grains that overfills its flat cells, past one free grain that feels
/// little but its own flow: what is rare elsewhere is counted here.
TinyScene syrup_through_a_layer();

/// The lid's bed with all terms that go together, between side walls.
TinyScene every_term();

/// Two grains at rest under a push of a thousand times their weight: no limit foresees how far the first step takes them, it
/// is undone and taken again shorter.
TinyScene taken_again();

/// A poured bed under a flow of one velocity at each height that answers to it or, driven by a gradient, does not.
TinyScene layers(FluidRung);

/// A layer of grains on the bottom, searched for its threshold: holds that branch from where it stood at first.
TinyScene search();

/// The lid's bed, sheared and come to rest again before its ramp.
TinyScene sheared();

/// The lid's bed, of which what lies deep is frozen until it is scoured.
TinyScene frozen_below();

/// Grains under ten times their weight, so that a hold is long enough for them to hop and rest many times.
TinyScene hopping();

inline std::vector<TinyScene> tiny_scenes() {
  return {lid_driven(),
          stream_on_a_slope(),
          suspension(),
          syrup_through_a_layer(),
          every_term(),
          taken_again(),
          layers(FluidRung::profile),
          layers(FluidRung::column),
          search(),
          sheared(),
          frozen_below(),
          hopping()};
}

}   // namespace bedload::test
