// SPDX-License-Identifier: Apache-2.0
// Keeper of a render under way: writes its state, and a picture to look at, every so often.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "integrator/render/render_job.h"
#include "io/base/notice.h"
#include "io/image/output.h"
#include "io/picture/picture.h"

namespace petzval::apps {

/// Files that are written during a render, and how often.
struct KeeperPlan {
    std::optional<double> checkpoint_s;  ///< time between two checkpoints; absent: none
    std::function<void(const integrator::PathStats&)> write_checkpoint;
    std::optional<std::filesystem::path> preview;  ///< .png or .jpg; absent: none
    std::function<io::Picture()> look;             ///< the picture so far, for the preview
    io::DisplayOptions display;
    io::Notice notice;  ///< gets one line where a preview or a checkpoint cannot be written
};

/// Asks a render to pause when something is due, from a thread of its own. Times are those of a
/// clock that never jumps. A file that cannot be written is told of once, and tried again when it
/// is due again: the render goes on.
class Keeper {
  public:
    /// All must outlive it.
    Keeper(KeeperPlan, integrator::RenderMonitor&);
    Keeper(const Keeper&) = delete;
    Keeper& operator=(const Keeper&) = delete;

    /// For RenderJob::at_pause.
    void at_pause(const integrator::PathStats&);
    /// Ends the thread, and writes the last preview: nothing is under way any more.
    void finish();

  private:
    void watch(const std::stop_token&);
    void write_preview(const io::Picture&);
    void attempt(const std::function<void()>& action, bool& told);

    KeeperPlan plan_;
    integrator::RenderMonitor& monitor_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    double checkpoint_due_s_, preview_due_s_;  ///< by steady_s(); infinite: never
    std::optional<io::Picture> to_show_;       ///< snapshot that is to be written
    double look_s_ = 0;                        ///< that it took
    /// Whether it was told that one cannot be written.
    bool checkpoint_told_ = false, preview_told_ = false;
    std::jthread thread_;  // last: it uses the rest, and ends first
};

}  // namespace petzval::apps
