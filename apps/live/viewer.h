// SPDX-License-Identifier: Apache-2.0
// View finder of one page: what it last asked for, as a picture that grows.
#pragma once

#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/render/render_session.h"
#include "apps/request/render_request.h"

namespace petzval::apps {

/// Picture as a page draws it.
struct LivePicture {
    V2i size_px{0};
    std::vector<uint8_t> rgba;  ///< of a display, alpha unassociated, row 0 at the top
};

enum class LiveStage : uint8_t {
    Idle,       ///< nothing is asked for
    Preparing,  ///< nothing of this request is seen yet
    Rough,      ///< a rough picture is, which is no part of what will be saved
    Growing,    ///< the true one is, with some of its samples
    Done,       ///< with all of them
    Failed      ///< see error
};

/// Camera as it was set up, for what a page does with it.
struct LiveCamera {
    std::string pose;     ///< as the field of that name has it
    std::string of_file;  ///< index of the file's camera that stands where it stands; empty: none
    float focus_m = 0;    ///< 0: a pinhole
    V2f sensor_mm{0.f};   ///< as much of it as the picture shows
    float yfov_deg = 0;
    std::optional<float> middle_m;  ///< depth of the picture's middle; absent: nothing is there
};

/// State of a view finder.
struct LiveStatus {
    uint64_t number = 0;   ///< grows with each change of the others
    uint64_t version = 0;  ///< of the request, as the page numbers them
    LiveStage stage = LiveStage::Idle;
    Phase phase = Phase::Loading;
    uint64_t picture = 0;          ///< number of the newest picture; 0: none yet
    uint32_t samples = 0, of = 0;  ///< of each pixel, at least; of: 0 where nobody knows
    double noise = 0, elapsed_s = 0;
    std::optional<LiveCamera> camera;
    std::vector<std::string> channels;  ///< that the true picture has
    std::vector<std::string> notices;
    std::string error;
};

/// A scene that pages share.
struct SharedScene {
    LoadedScene loaded;
    std::string stamp;                   ///< sizes and times of its files when they were read
    std::vector<std::string> notices{};  ///< what loading it told
};

/// Renders what was asked for last, in a thread of its own; what a newer request has in common with
/// the one before is kept. All functions may be called from any thread.
class Viewer {
  public:
    /// Starts with nothing to do. scene: one that is loaded already, or nothing. Files that change
    /// are read anew by the next request.
    Viewer(int threads, SharedScene scene);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Asks for another picture; what is under way ends at once.
    void ask(uint64_t version, RenderRequest);
    /// Stops what is under way, until ask() is called again.
    void leave();

    [[nodiscard]] LiveStatus status() const;
    /// Waits until the status has another number than that, or for so long.
    [[nodiscard]] LiveStatus wait(uint64_t number, std::chrono::milliseconds) const;
    /// The newest picture; nullptr: none yet.
    [[nodiscard]] std::shared_ptr<const LivePicture> picture() const;
    /// The scene as it is loaded; empty before.
    [[nodiscard]] SharedScene scene() const;

    /// Calls f with the session while no sample is under way, and waits for it; the film may be
    /// read. Throws what f throws, and ArgumentError where the true picture of that request is not
    /// what is shown.
    void inspect(uint64_t version, const std::function<void(const RenderSession&)>& f);
    /// Writes the picture of a request once it is done, as the command line writes it. Throws
    /// InputError, also where it is not done.
    void write(uint64_t version, const std::filesystem::path&);

  private:
    struct Job {
        uint64_t ticket = 0, version = 0;
        RenderRequest request;
    };
    struct Question {
        std::function<void(const RenderSession&)> f;
        std::promise<void> answered;
    };
    void work(const std::stop_token&);
    void answer_questions();
    void refuse_questions();
    void show(const Job&);
    void show_rough(const Job&);
    void show_true(const Job&);
    void prepare(const Job&, const RenderRequest&, std::vector<std::string>& notices);
    void render(const Job&, integrator::RenderMonitor&, const RenderRun&);
    [[nodiscard]] bool stale(const Job&) const;
    void publish(const Job&, const std::function<void(LiveStatus&)>& change,
                 std::shared_ptr<const LivePicture> picture = nullptr);

    mutable std::mutex mutex_;  ///< of all that is not said to be the thread's own
    mutable std::condition_variable_any changed_;
    uint64_t ticket_ = 0;  ///< of the newest request, or of having left
    std::optional<Job> next_;
    integrator::RenderMonitor* running_ = nullptr;
    LiveStatus status_;
    std::shared_ptr<const LivePicture> picture_;
    SharedScene scene_;
    std::vector<Question> questions_;

    RenderSession session_;                    ///< the thread's own
    std::optional<RenderRequest> rendered_;    ///< likewise: what the film is of
    double samples_per_s_ = 0, set_up_s_ = 0;  ///< likewise: of rough pictures
    std::jthread thread_;                      ///< last: it uses the others
};

}  // namespace petzval::apps
