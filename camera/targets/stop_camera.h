// SPDX-License-Identifier: Apache-2.0
// Cameras with a stop: which ray of a film point crosses it where. What rays to targets need to
// know of a camera. A class C of them has, in camera/targets/stop_camera.cpp, what stands here.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <variant>

#include "camera/camera.h"
#include "camera/models/aberrated_lens.h"
#include "camera/models/lens_camera.h"
#include "camera/models/thin_lens.h"
#include "core/spectrum/glass.h"

namespace petzval::camera {

/// Line d, in light of which lanes count that have no wavelength, nm.
inline constexpr auto kMiddle_nm = static_cast<float>(kLineD_nm);

/// A camera whose rays can be aimed at points of its stop. A thin lens has an iris.
using StopCamera =
    std::variant<std::shared_ptr<const ThinLensCamera>, std::shared_ptr<const AberratedLensCamera>,
                 std::shared_ptr<const LensCamera>>;

/// The camera as one with a stop; nothing for another.
[[nodiscard]] std::optional<StopCamera> stop_camera(const std::shared_ptr<const Camera>&);

/// Points of the stop of a batch of film points, mm.
using StopPoints = std::array<V2f, kMostFilmPoints>;

/// Ray of a film point beyond the lens, in the camera's space.
struct StopRay {
    V3d origin_m{0.}, direction{0.};
    bool exists = false;
    bool clear = false;  ///< no rim stops it
};

/// Where the lanes of a ray cross the stop, and the density with which the ray was drawn, in any
/// unit: those of stretch times 1/mm^2.
struct StopCrossings {
    size_t lanes = 0;
    std::array<V2f, 4> stop_mm{};
    std::array<float, 4> nm{}, stretch{};
};

/// Radius of the stop, mm.
[[nodiscard]] double stop_reach_mm(const StopCamera&);
[[nodiscard]] double iris_area_mm2(const StopCamera&);
[[nodiscard]] const Iris& iris_of(const StopCamera&);
[[nodiscard]] const Pose& pose_of(const StopCamera&);
/// Wavelength for which points of the stop are drawn, nm in air.
[[nodiscard]] float leading_nm(const StopCamera&, const Bands&);
/// Whether the rays of a film point are those of one lane, which leads.
[[nodiscard]] bool is_led(const StopCamera&, const FilmPoint&, const Bands&);
/// A film point, a wavelength, and a point of the stop.
struct StopPoint {
    V2f film, stop_mm;
    float nm;
};
/// Rays of film points through points of the stop.
[[nodiscard]] std::array<StopRay, 8> rays_through(const StopCamera&,
                                                  const std::array<StopPoint, 8>&);
/// Points of the stop that the samplers of film points draw.
[[nodiscard]] StopPoints drawn_stop_mm(const StopCamera&, std::span<const FilmPoint>);
/// Samples of film points through points of the stop. Crossings are filled in for those that are
/// asked for and have paths; CameraSample::density is that of a draw.
void sample_through(const StopCamera&, std::span<const FilmPoint>, std::span<const Bands>,
                    const StopPoints&, std::span<CameraSample>,
                    const std::array<bool, kMostFilmPoints>& asked,
                    std::array<StopCrossings, kMostFilmPoints>&);

}  // namespace petzval::camera
