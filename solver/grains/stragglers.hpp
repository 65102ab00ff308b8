// The few grains of a bed that still move, with their neighbourhood, as grains of their own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// A part of a bed, cut out to be moved alone: stragglers, all grains within half a diameter of one, and, held fixed, all
/// within half a diameter of those. The ids of the part are in the order of the bed's.
class Stragglers {
 public:
  /// Of a grain's diameter around it: where that of two grains meets, they are neighbours [-].
  static constexpr double margin = 0.25;

  /// `awake`: one entry per grain, 1 for a straggler. Positions may lie outside a periodic box.
  void cut_out(const BedScene&, const Grains&, const ContactHistory&, std::span<const std::uint8_t> awake);
  /// Puts the part back: motion and mean forces of the grains that were free in it, and every contact of theirs. All
  /// other grains of the bed were held, and are at rest.
  void put_back(Grains&, ContactHistory&) const;

  Grains grains;
  ContactHistory contacts;

 private:
  std::vector<std::uint32_t> id_;        // in the bed, of each grain of the part
  std::vector<std::uint8_t> free_;       // one entry per grain of the bed
  std::vector<std::uint32_t> part_id_;   // of each grain of the bed that is in the part
};

}   // namespace bedload
