// SPDX-License-Identifier: Apache-2.0
// Request for a render: all that its picture follows from, as one value.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/request/scene_request.h"
#include "core/film/film.h"
#include "core/sampling/filter.h"
#include "core/sampling/sampler.h"
#include "integrator/path/path_options.h"
#include "integrator/render/render_job.h"

namespace petzval::apps {

inline constexpr double kUsualTolerance = 0.01;
inline constexpr uint32_t kUsualSamples = 64;
/// Most samples of a pixel where a noise is to be reached.
inline constexpr uint32_t kUsualNoiseSamples = 4096;
/// Number of samples that no render reaches: what a time limit alone asks for.
inline constexpr uint32_t kMostSamples = 1u << 30;

/// Moment of an animation.
struct Moment {
    double value = 0;
    bool is_frame = false;  ///< number of a frame, which may be a fraction; else seconds
};

/// Time that a shutter takes.
struct ShutterTime {
    double value = 0;
    bool is_angle = false;  ///< degrees, of which 360 are the time of a frame; else seconds
};

/// Moment of a scene that moves.
struct MomentRequest {
    std::optional<Moment> at;             ///< absent: the pose that the file stores
    std::vector<std::string> animations;  ///< names or numbers; none: all that agree
    double fps = 24;                      ///< frames in a second
    bool loop = false;                    ///< animations begin anew at their ends
    std::optional<ShutterTime> shutter;   ///< absent: nothing is blurred
    std::string shutter_curve;            ///< "box", "trapezoid" or a CSV file; empty: box
};

/// Band of a frame, over its whole width: the part-th of so many, from 1, from the top. Bands are
/// of whole cells of a noise (integrator/render/noise_target.h).
struct FrameBand {
    int part = 1, of = 1;
};
/// Part of a full frame.
using Crop = std::variant<Rect, FrameBand>;

/// Pixels of a crop of a frame, where it lies inside (check() of a request sees to it); without one
/// all of them.
[[nodiscard]] Rect pixels_of(const std::optional<Crop>&, V2i frame_px);

/// Samples of each pixel.
struct SampleRequest {
    /// Absent: kUsualSamples, or as the time limit allows; with a noise the most of each pixel.
    std::optional<uint32_t> count;
    /// Of each cell (integrator/render/noise_target.h), or the error of the picture that is
    /// denoised; above 0.
    std::optional<double> noise;
    std::optional<SampleRange> range;    ///< in place of a count: a part of a picture
    std::optional<double> time_limit_s;  ///< ends with the samples that are under way then
    uint32_t seed = 0;
    SamplerKind sampler = SamplerKind::Owen;
    FilterKind filter = FilterKind::BlackmanHarris;
    std::optional<float> filter_radius_px;  ///< absent: as suits the filter
    std::optional<float> clamp_nits;        ///< largest R, G or B of a sample
};

/// Exposure of PNG and JPEG.
struct ExposureRequest {
    bool is_auto = false;  ///< a pilot finds it
    float ev = 0;          ///< else
};

/// How PNG and JPEG show a picture. EXR keeps the light.
struct DisplayRequest {
    std::optional<ExposureRequest> exposure;  ///< absent: that of the scene's file, or 0 EV
    std::string view;                         ///< empty: that of the scene's file, or the default
    std::filesystem::path config;             ///< of OpenColorIO; empty: Petzval's own
};

/// Numbers, names and files; nothing is read yet. A RenderSession makes a picture of it.
struct RenderRequest {
    SceneRequest scene;  ///< resolved() sets the times of its animation and of its camera's shutter
    MomentRequest moment;
    std::optional<Crop> crop;  ///< absent: the full frame
    std::vector<Aov> layers;
    bool denoise = false;  ///< and say how large the error is
    SampleRequest samples;
    integrator::PathOptions path;
    double tolerance = kUsualTolerance;  ///< of what is chosen for the user, above 0
    DisplayRequest display;
};

/// Throws ValueError where the members of a request do not go together.
void check(const RenderRequest&);

/// The scene of a request, with the times of its animation and shutter. Throws InputError for the
/// file of a shutter curve.
[[nodiscard]] SceneRequest resolved_scene(const RenderRequest&);

/// The job of a request, without what its scene adds: observer and velocities.
[[nodiscard]] integrator::RenderJob job_of(const RenderRequest&);

}  // namespace petzval::apps
