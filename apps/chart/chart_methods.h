// SPDX-License-Identifier: Apache-2.0
// Methods that a chart compares: those of each axis, as variations of one request, and the one that
// makes their reference.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/request/option_names.h"
#include "apps/setup/render_setup.h"
#include "core/film/film.h"
#include "integrator/render/render_job.h"

namespace petzval::apps {

/// Axes of a chart.
enum class ChartAxis : uint8_t {
    Camera,
    Dispersion,
    Spectral,
    Iris,
    Sampler,
    Lights,
    Targets,
    Ghosts,
    Diffraction,
    Precision,
    Noise
};

/// In the order of a report.
template <>
inline constexpr auto kOptionNames<ChartAxis> =
    std::to_array<OptionName<ChartAxis>>({{"camera", ChartAxis::Camera},
                                          {"dispersion", ChartAxis::Dispersion},
                                          {"spectral", ChartAxis::Spectral},
                                          {"iris", ChartAxis::Iris},
                                          {"sampler", ChartAxis::Sampler},
                                          {"lights", ChartAxis::Lights},
                                          {"targets", ChartAxis::Targets},
                                          {"ghosts", ChartAxis::Ghosts},
                                          {"diffraction", ChartAxis::Diffraction},
                                          {"precision", ChartAxis::Precision},
                                          {"noise", ChartAxis::Noise}});

/// Words for the axes, and "all".
[[nodiscard]] std::vector<std::string> axis_words();
/// Axes of these words; all of them where there is none. Throws ValueError.
[[nodiscard]] std::vector<ChartAxis> parse_axes(const std::string& option,
                                                const std::vector<std::string>& words);

/// What is rendered, and shown.
enum class ChartPicture : uint8_t {
    Samples,   ///< as many of each pixel
    Noise,     ///< to a noise: 1 / sqrt(n) stands for n samples
    Denoised,  ///< what denoising makes of as many samples of each pixel
};

struct ChartMethod {
    std::string name;
    SceneRequest scene;
    integrator::RenderJob job;
    ChartPicture picture = ChartPicture::Samples;

    /// What a film of it keeps.
    [[nodiscard]] FilmKeeps keeps() const {
        return {.blocks = picture == ChartPicture::Noise,
                .halves = picture == ChartPicture::Denoised};
    }
};

/// Methods compared with one reference: those of an axis, or for the iris those of one shape.
struct ChartCase {
    ChartAxis axis;
    std::string name;   ///< of its files: "sampler", "iris-star"
    std::string title;  ///< one line
    std::vector<ChartMethod> methods;
    ChartMethod reference;             ///< its name says how it differs from the methods
    std::vector<std::string> remarks;  ///< what was chosen for the user or left out, and why
    double weight = 1;                 ///< share of the time against other cases
};

/// The lens of the axes that need one, where the request has none.
inline constexpr const char* kChartLens = "double-gauss-100mm-f2";

struct ChartSubject {
    SceneRequest request;
    integrator::RenderJob job;
    std::filesystem::path folder;  ///< where shapes of irises are written
};

/// Function that sets up another view of the scene: set_up_view with its setup and notice given.
using SetUpView = std::function<RenderSetup(const SceneRequest&)>;

/// Cases of the axes. Opens the scene, to see what it allows. A case without methods only has
/// remarks. Throws InputError for faults of the scene, ArgumentError where an axis that needs a
/// perspective camera gets none.
[[nodiscard]] std::vector<ChartCase> chart_cases(const std::vector<ChartAxis>&, const ChartSubject&,
                                                 const SetUpView&);

}  // namespace petzval::apps
