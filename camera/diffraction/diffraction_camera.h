// SPDX-License-Identifier: Apache-2.0
// Camera whose light is diffracted by its stop.
#pragma once

#include <memory>

#include "camera/diffraction/lamp_images.h"

namespace petzval::camera {

/// Where light of a camera goes by diffraction, and which lamps have stars.
struct Diffraction {
    FilmSpread spread;
    LampImages lamps;
    /// Frequency of the pupil, cycles/mm, below which displacements are so far below a pixel that
    /// lanes share them as they are.
    float shared = 0;
};
/// That frequency for a frame of so many pixels: light of line d is displaced by a third of one,
/// and that of 450 or 700 nm by a tenth of one less or more.
[[nodiscard]] float shared_frequency(const FilmSpread&, V2i frame_px);

/// Rays of another camera from displaced film points: each by a draw of the diffraction pattern as
/// that film point sees it, so that the picture is that of rays, spread by the pattern. A sample
/// belongs to its pixel still. All lanes share a displacement, drawn for one of them; beyond
/// Diffraction::shared it is weighed by the mean density of all. Where lamps shine, more samples go
/// to their images; each draw is weighed by the density of both (balance heuristic, Veach and
/// Guibas 1995).
class DiffractionCamera final : public Camera {
  public:
    /// far: the same rays without those to targets that are sharp, whose displacement is weighed.
    DiffractionCamera(std::shared_ptr<const Camera> rays, std::shared_ptr<const Camera> far,
                      std::shared_ptr<const Diffraction> light)
        : rays_(std::move(rays)), far_(std::move(far)), light_(std::move(light)) {}

    [[nodiscard]] CameraSample sample(const FilmPoint& point, const Bands& bands) const override {
        return one_of_all(point, bands);
    }
    void sample_all(std::span<const FilmPoint>, std::span<const Bands>,
                    std::span<CameraSample>) const override;

  private:
    struct Displaced {
        V2f film;
        f4 lanes;   ///< factor of each lane's weight
        float mis;  ///< CameraPath::mis_weight
        bool is_far = false;
    };
    /// Displacements of a sample: by the pattern, and towards a lamp where one is looked for.
    struct OfSample {
        Displaced by_pattern;
        std::optional<Displaced> to_lamp;
    };
    [[nodiscard]] OfSample displaced(const FilmPoint&, const Bands&) const;

    std::shared_ptr<const Camera> rays_, far_;
    std::shared_ptr<const Diffraction> light_;
};

}  // namespace petzval::camera
