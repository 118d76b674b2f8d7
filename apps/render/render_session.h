// SPDX-License-Identifier: Apache-2.0
// A render from a request to a picture in memory, without files of its own and without a console.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "apps/plan/plan.h"
#include "apps/request/render_request.h"
#include "apps/setup/denoised_film.h"
#include "apps/setup/exposure.h"
#include "apps/setup/render_setup.h"
#include "apps/state/render_facts.h"
#include "integrator/render/executor.h"
#include "integrator/render/noise_target.h"
#include "integrator/render/render_job.h"
#include "integrator/render/sample_record.h"
#include "io/base/notice.h"
#include "io/image/output.h"
#include "io/state/state_file.h"

namespace petzval::apps {

/// What the film of a request keeps.
[[nodiscard]] io::FilmShape shape_of(const RenderRequest&);

/// How a render runs; nothing of it changes a sample.
struct RenderRun {
    /// As in RenderJob; the film and the picture may be looked at there.
    std::function<void(const integrator::PathStats&)> at_pause{};
    double spent_s = 0;   ///< of a time limit, by runs before
    bool timing = false;  ///< measure where the time goes
    PhaseSink begins{};   ///< gets the phases that begin
    /// Denoises at the end, where the request says so; a part that is merged later needs no
    /// picture.
    bool denoises = true;
};

/// A scene that is loaded, and the request that it was loaded for. Copies are cheap.
struct LoadedScene {
    PreparedScene prepared;  ///< nothing in it: none is loaded
    SceneRequest asked;
};

/// Session of renders that follow each other: what a request has in common with the one before is
/// kept. The same scene is not loaded again; the same light keeps its samples, so that more of them
/// or another exposure cost only what is new.
///
/// Threads: calls come from one thread at a time; a monitor may be used from any. Rendering takes
/// the threads of the session and the calling one, whose denormals become zero. Errors: an
/// exception leaves the session without a render, ready for the next request, with the scene that
/// it had. Lifetime: what is returned by reference, and rows of a picture, hold until the next call
/// of prepare(). Bytes: a picture depends on its request alone, not on the requests before, on
/// pauses or on threads.
class RenderSession {
  public:
    /// Frames: whether most requests will differ in their time alone, so that each frame takes what
    /// it can from the one before, which is then gone.
    enum class Frames : uint8_t { Single, Sequence };

    /// Starts a session of so many threads, 1 or more.
    explicit RenderSession(int threads, Frames = Frames::Single);
    RenderSession(const RenderSession&) = delete;
    RenderSession& operator=(const RenderSession&) = delete;

    [[nodiscard]] int threads() const { return executor_.threads(); }

    /// Loads what a request needs, and chooses what it leaves open. `notice` gets a line for each
    /// choice and oddity, `begins` the phases. Throws InputError; ArgumentError where the request
    /// does not fit its scene.
    void prepare(const RenderRequest&, const io::Notice& notice, const PhaseSink& begins = {});

    /// Takes a scene that another session has loaded: a request for the same one shares it.
    void take(LoadedScene);
    /// The scene that is loaded.
    [[nodiscard]] LoadedScene scene() const { return {setup_.prepared, setup_.from.asked}; }

    /// The scene with all choices made. After prepare(), as the functions below.
    [[nodiscard]] const RenderSetup& setup() const { return setup_; }
    /// How PNG and JPEG show the picture.
    [[nodiscard]] const io::DisplayOptions& display() const { return display_; }
    [[nodiscard]] const io::FilmShape& shape() const { return shape_; }
    /// Facts that the picture follows from.
    [[nodiscard]] const RenderFacts& facts() const { return facts_; }

    /// Goes on with a film of the same facts and shape, as a state has it.
    void take_up(Film film) { film_ = std::move(film); }
    /// The samples so far.
    [[nodiscard]] const Film& film() const { return *film_; }

    /// Renders the samples that the film lacks, and denoises them where that is asked for. Ends
    /// early where the monitor says stop; calling again goes on.
    integrator::RenderResult render(integrator::RenderMonitor&, const RenderRun& = {});

    /// The denoised picture of all samples; empty where none is asked for, or render() was stopped.
    [[nodiscard]] const std::shared_ptr<const DenoisedFilm>& denoised() const { return denoised_; }
    /// The picture so far as it would be shown, R, G, B and A, denoised where that is asked for.
    /// Also at a pause.
    [[nodiscard]] io::Picture look(const integrator::RenderMonitor&);

    /// How a sample comes about, whether the film has it or not; its pixel lies in the full frame.
    [[nodiscard]] integrator::SampleRecord trace_sample(SampleId) const;

    /// What a film of this render has reached of the noise that is asked for; nothing where none
    /// is.
    [[nodiscard]] std::optional<integrator::NoiseReport> noise(const Film&) const;

    /// The picture so far: R, G, B, A in nits, then the layers. Also at a pause.
    [[nodiscard]] io::PictureRows light() const;
    /// The picture so far as a display shows it.
    [[nodiscard]] io::PictureRows shown() const;
    /// The picture so far with what a file of that name says of it. Also at a pause.
    [[nodiscard]] io::PictureRows picture(const std::filesystem::path&) const;
    /// Writes the picture so far, as the command line writes it. Throws OutputError.
    void write(const std::filesystem::path&) const;

    /// Exposure that suits the picture, found by a pilot.
    [[nodiscard]] FoundExposure find_exposure();

  private:
    void prepare_like(RenderSetup before, const RenderRequest&, const io::Notice&,
                      const PhaseSink&);
    [[nodiscard]] SampleRange complete() const;
    [[nodiscard]] integrator::RenderResult render_to_denoised(
        integrator::RenderJob,
        const std::function<integrator::RenderResult(const integrator::RenderJob&)>& render_all,
        integrator::RenderMonitor&);
    void choose_display(const io::Notice&);
    void warn_of_lamps(const io::Notice&) const;

    integrator::TbbExecutor executor_;
    std::optional<FrameReuse> frames_;
    RenderRequest request_;
    SceneRequest scene_;  ///< of the request, resolved
    integrator::RenderJob job_;
    integrator::PathOptions path_;
    io::DisplayOptions display_;
    RenderSetup setup_;
    io::FilmShape shape_;
    RenderFacts facts_;
    std::unique_ptr<NextFrame> next_;
    std::optional<Film> film_;
    std::shared_ptr<const DenoisedFilm> denoised_;
};

}  // namespace petzval::apps
