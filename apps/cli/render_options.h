// SPDX-License-Identifier: Apache-2.0
// The options of petzval render.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/camera_options.h"
#include "apps/cli/keep_options.h"
#include "apps/cli/progress.h"
#include "apps/cli/reading_options.h"
#include "apps/cli/sequence_options.h"
#include "apps/cli/spectral_options.h"
#include "apps/setup/render_setup.h"
#include "core/film/film.h"
#include "integrator/path.h"
#include "integrator/path_options.h"
#include "integrator/render_job.h"
#include "io/image/output.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace petzval {

/// Number of samples that no render reaches: what --time alone asks for.
inline constexpr uint32_t kMostSamples = 1u << 30;

/// Render options as given; the texts become values in resolve().
struct RenderOptions {
    SceneRequest scene;
    SpectralOptions spectral;
    CameraOptions camera;
    ReadingOptions reading;
    std::vector<std::filesystem::path> outputs;  ///< pictures, and before resolve() a state
    KeepOptions keep;
    std::optional<std::filesystem::path> stats;
    std::string size = "1280x720", crop, samples, time, background, tolerance = "1%";
    std::optional<std::string> exposure;
    std::vector<std::string> aovs;  ///< lists of names
    std::optional<uint32_t> spp;
    int threads = 0;  ///< 0: as many as can be had
    RenderJob job;
    PathOptions path;
    FilterKind filter = FilterKind::BlackmanHarris;
    float filter_radius_px = 0;
    DisplayOptions display;
    std::vector<const CLI::Option*> display_only;  ///< options that an EXR takes no notice of
    bool auto_exposure = false;
    bool asks_view = false;  ///< by its option
    ProgressStyle progress = ProgressStyle::Auto;
    bool quiet = false;
    SequenceOptions sequence;
};

/// Values from the texts of RenderOptions that have no place elsewhere.
struct RenderFrame {
    Rect crop;
    std::vector<Aov> aovs;
    double tolerance = 0;
    std::vector<std::string> remarks;  ///< to be told
};

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_render_options(CLI::App&, RenderOptions&);

/// Declares the options of petzval plan: those that a prediction depends on.
void add_plan_options(CLI::App&, RenderOptions&);

/// Declares the options of a scene's light; they write to the arguments, which must outlive the
/// parsing. The text becomes a value in resolve_background().
void add_light_options(CLI::App&, SceneRequest&, std::string& background);
/// Sets the background from its text; an empty one changes nothing. Throws CLI::ValidationError.
void resolve_background(const std::string& text, SceneRequest&);

/// Reads the options that depend on each other. Throws CLI::ValidationError.
[[nodiscard]] RenderFrame resolve(RenderOptions&);

}  // namespace petzval
