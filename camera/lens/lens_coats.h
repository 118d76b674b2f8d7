// SPDX-License-Identifier: Apache-2.0
// Coats of a lens: the one place that says what each surface reflects, lets through and absorbs.
#pragma once

#include <vector>

#include "camera/lens/coating.h"
#include "camera/lens/lens_ray.h"

namespace petzval {

/// Coatings of all surfaces of a lens, for analyses: exact, in doubles.
class LensCoats {
  public:
    /// coating: of every surface, or Filed. A coating by name leaves a surface bare that does not
    /// touch air.
    LensCoats(const Lens&, Coating);

    /// What becomes of light that meets a surface on its way. All of it passes where the medium
    /// stays the same.
    [[nodiscard]] SurfaceShares at(int surface, Towards, const Incidence&) const;
    /// Whether light loses nothing there, whatever comes: the medium stays, or Ideal.
    [[nodiscard]] bool ideal(int surface) const { return coats_[size_t(surface)].ideal; }
    [[nodiscard]] const LayerStack& layers(int surface) const {
        return coats_[size_t(surface)].layers;
    }

  private:
    struct Coat {
        bool ideal = false;
        bool air_behind = false;  ///< and glass before: the layers lie the other way round
        LayerStack layers;
    };
    std::vector<Coat> coats_;
};

/// Transmittance of the surfaces of a lens, for rendering.
class CoatTables {
  public:
    /// Makes tables for the coatings that have no formula of their own in coating.h, of LensCoats:
    /// some ms a surface, or ten times that where a coat is thicker than 2 um.
    CoatTables(const Lens&, Coating);

    /// Transmittance, a share of light, of a surface where the medium changes; linear between
    /// entries of 10 nm (1 nm for a thick coat) and cosines of 1/128 in the medium of the lower
    /// index: within 2e-3 of LensCoats up to 84 degrees, within 1e-3 up to 35.
    [[nodiscard]] f4 transmittance(int surface, const Crossing&, f4 nm) const;

  private:
    struct Table {
        bool touches_air = false;
        int step_nm = 0;           ///< 0: of its formula
        std::vector<float> share;  ///< by wavelength, by cosine
    };
    Coating coating_;
    std::vector<Table> tables_;
};

}  // namespace petzval
