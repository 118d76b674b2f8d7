// SPDX-License-Identifier: Apache-2.0
// Luminous intensity of a luminaire by direction, as a goniophotometer measures it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math/math.h"

namespace petzval {

/// Axes about which the angles of a profile turn, in the light's own space: it shines along `f`,
/// and x and y lie across. Forward: the pole is f, the azimuth runs from x to y (type C photometry
/// of IES LM-63). Side: the pole is -x, the azimuth runs from y to f (type B).
enum class ProfilePole : uint8_t { Forward, Side };

/// Intensities at the knots of a grid of angles, bilinear between them; 0 beyond its ends.
class LightProfile {
  public:
    /// Ascending, two angles of each at least: polar from 0 to 180, azimuth from at most 0 to at
    /// least 360 where it goes all around. Intensities: all polar angles of the first azimuth, then
    /// of the next.
    LightProfile(ProfilePole, std::vector<float> polar_deg, std::vector<float> azimuth_deg,
                 std::vector<float> intensity_cd);

    /// Intensity, cd, in a unit direction, given by its components along x, y and f.
    [[nodiscard]] float intensity(const V3f& direction) const;
    /// Luminous flux, lumen: the integral of what intensity() gives over all directions.
    [[nodiscard]] float flux_lm() const { return flux_lm_; }
    /// Greatest angle from f, radians, at which there is light.
    [[nodiscard]] float reach_rad() const { return reach_rad_; }

  private:
    ProfilePole pole_;
    std::vector<float> polar_deg_, azimuth_deg_, intensity_cd_;
    float flux_lm_, reach_rad_;
    [[nodiscard]] double integral() const;
    [[nodiscard]] float reach() const;
};

}  // namespace petzval
