// How fluid and grains answer a pressure kick together, so that the projection moves both.
#pragma once

#include <span>
#include <vector>

#include "solver/coupling/void_fraction.hpp"
#include "solver/scene.hpp"

namespace bedload {

/// On faces, at the new positions. A kick T grad dq takes T fluid grad dq from the fluid's velocity and T grains grad dq,
/// sampled, from each mobile grain's; the net volume flux changes by T coefficient grad dq.
struct MixtureResponse {
  MixtureResponse() = default;
  explicit MixtureResponse(const StaggeredGrid&);
  FaceFields fluid, grains, coefficient;        // cf, cp, eps cf + phi_M cp; 1, 0, 1 where no grain reaches
  Deposited locked_exchange, mobile_exchange;   // B of fixed grains, of all others: sum w beta T/V_c
  Deposited mobile_fraction, mobile_inertia;    // share of the pressure's force (phi_M), and sum w M/(rho_f V_c)
  Woven locked, exchange, fraction, inertia;    // scratch
};

/// Backward Euler on the pair of fluid and mobile grains at each face, coupled by drag:
///   (eps + B_L + B_M) cf - B_M cp = eps,   (phi_M s + B_M) cp - B_M cf = phi_M     (Model A)
/// with 1 and 0 on the right in Model B, where pressure acts on the fluid alone. On an overfilled face the right-hand phi_M is
/// the part that fits.
void find_mixture_response(const StaggeredGrid&, const Grains&, const Stencils&, std::span<const Vec3> exchange,
                           double fluid_density, const VoidFraction&, bool model_b, MixtureResponse&,
                           const KernelSmoothing& = {});

}   // namespace bedload
