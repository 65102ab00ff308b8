// The rungs below the box: a flow that has one velocity at each height, in layers of the box's height of cells.
#pragma once

#include <span>

#include "solver/coupler_rung.hpp"
#include "solver/coupling/column_exchange.hpp"
#include "solver/fluid/column_flow.hpp"

namespace bedload {

/// The column that a scene with layers asks for.
Column column_of(const Scene&);

/// Grains in a layered flow: they sample it by their slices, and feel its drag as in the box. Across and upwards the fluid is at rest.
class Coupler::Layers : public Rung {
 public:
  void step(State&, double longest) final;

 protected:
  explicit Layers(const Scene&);

  const Column column;
  const double area;   // of a layer [m2]
  ColumnFlow fluid;
  GrainSlices slices;
  SolidLayers solid;
  /// By layer: of added mass, what does not go along with the grains; all of it where the flow is given [-].
  std::vector<double> held_back;

  /// u of all layers, as it stands in the state.
  std::span<double> profile(State&) const;
  void place_in_layers(const Grains&);
  void sample_at_grains(State&);

 private:
  /// d/dz of the viscous stress that grains feel at the start of the step, by layer [m/s2].
  virtual std::span<const double> stress_divergence(const State&, std::span<const double> u) = 0;
  /// The fluid goes on to the end of the step; where it does not answer, it stays. Books what walls and drive exchange with it.
  virtual void advance_fluid(State&, double dt) = 0;
  /// What the grains' motion displaces and carries along.
  virtual void displace_fluid(State&, double dt) = 0;

  void sample_stress(std::span<const double> divergence, const State&);
  void sample_vorticity(State&);
  void feel_end_of_step(State&);
  void turn_grains(State&, double dt);
  void book_liquid(const Grains&);

  std::vector<double> shear_;           // du/dz of each layer [1/s]
  std::vector<double> stress_before_;   // by id: the acceleration that the prediction has met [m/s2]
};

/// The one-dimensional balance, both ways.
class Coupler::ColumnRung final : public Layers {
 public:
  explicit ColumnRung(const Scene& given) : Layers(given) {}
  std::vector<double> steady_column(const Grains&, const ImposedFlow&) override;

 private:
  std::span<const double> stress_divergence(const State&, std::span<const double> u) override;
  void advance_fluid(State&, double dt) override;
  void displace_fluid(State&, double dt) override;

  void push_liquid(State&, double dt);

  LayerExchange exchange_;
  std::vector<Vec3> answer_;    // by id: (beta T + m_a)/T [m3/s]
  std::vector<double> along_;   // by layer: added mass per volume and fluid density [-]
  SolidLayers moved_solid_;
};

/// The flow that a hold imposes: what it does to grains comes back to nobody.
class Coupler::ProfileRung final : public Layers {
 public:
  explicit ProfileRung(const Scene&);

 private:
  std::span<const double> stress_divergence(const State&, std::span<const double> u) override;
  void advance_fluid(State&, double dt) override;
  void displace_fluid(State&, double) override {}

  const SolidLayers no_solid_;   // the stress is that of the flow as if no grain stood in it
};

}   // namespace bedload
