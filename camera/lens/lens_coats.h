// SPDX-License-Identifier: Apache-2.0
// Coats of a lens: the one place that says what each surface reflects, lets through and absorbs.
#pragma once

#include <vector>

#include "camera/lens/coating.h"
#include "camera/lens/lens_ray.h"

namespace petzval::camera {

/// Coatings of all surfaces of a lens, for analyses: exact, in doubles.
class LensCoats {
  public:
    /// coating: of every surface, Filed, or Year, for which the lens must have one. A coating by
    /// name leaves a surface bare that does not
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
    /// The lens must outlive it. Makes tables for the coatings that have no formula of their own in
    /// coating.h, as fine as each stack needs: some ms a surface. One that is too thick for a table
    /// has none.
    CoatTables(const Lens&, Coating);

    /// Transmittance, a share of light, of a surface where the medium changes: within 2e-3 of
    /// LensCoats up to 84 degrees in the medium of the lower index.
    [[nodiscard]] f4 transmittance(int surface, const Crossing&, f4 nm) const;
    /// The coats, exact.
    [[nodiscard]] const LensCoats& coats() const { return coats_; }

  private:
    struct Table {
        bool touches_air = false;
        bool formula = true;         ///< of coating.h, and no table
        int waves = 0, cosines = 0;  ///< cells; 0: too many would be needed
        std::vector<float> share;    ///< by wavelength, by cosine
    };
    [[nodiscard]] double exact(int surface, double cosine, double nm) const;
    [[nodiscard]] bool fits(int surface, int waves, int cosines) const;

    const Lens* lens_;
    Coating coating_;
    LensCoats coats_;
    std::vector<Table> tables_;
};

}  // namespace petzval::camera
