// SPDX-License-Identifier: Apache-2.0
#include "apps/state/keeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <utility>

namespace petzval::apps {
namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();
/// Time between two previews: a few seconds, and more where writing one takes long, so that it
/// costs at most a twentieth of one thread.
constexpr double kPreview_s = 3, kPreviewShare = 1. / 20;

}  // namespace

Keeper::Keeper(KeeperPlan plan, integrator::RenderMonitor& monitor)
    : plan_(std::move(plan)),
      monitor_(monitor),
      checkpoint_due_s_(integrator::steady_s() + plan_.checkpoint_s.value_or(kNever_s)),
      preview_due_s_(plan_.preview ? integrator::steady_s() + 1 : kNever_s) {
    if (plan_.checkpoint_s || plan_.preview)
        thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

void Keeper::finish() {
    if (!thread_.joinable()) return;
    thread_.request_stop();
    thread_.join();
    if (plan_.preview) attempt([&] { write_preview(plan_.look()); }, preview_told_);
}

void Keeper::at_pause(const integrator::PathStats& stats) {
    bool checkpoint = false, preview = false;
    {
        const std::lock_guard lock(mutex_);
        const double now_s = integrator::steady_s();
        checkpoint = now_s >= checkpoint_due_s_;
        preview = now_s >= preview_due_s_;
    }
    if (checkpoint) attempt([&] { plan_.write_checkpoint(stats); }, checkpoint_told_);
    std::optional<io::Picture> now;
    const double start_s = integrator::steady_s();
    if (preview) attempt([&] { now = plan_.look(); }, preview_told_);
    const std::lock_guard lock(mutex_);
    look_s_ = integrator::steady_s() - start_s;
    if (checkpoint) checkpoint_due_s_ = integrator::steady_s() + *plan_.checkpoint_s;
    if (preview) {
        to_show_ = std::move(now);
        preview_due_s_ = kNever_s;  // until it is written
    }
    wake_.notify_one();
}

void Keeper::watch(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        if (to_show_) {
            const io::Picture picture = std::move(*to_show_);
            to_show_.reset();
            const double start_s = integrator::steady_s() - look_s_;
            lock.unlock();
            attempt([&] { write_preview(picture); }, preview_told_);
            const double pause_s =
                std::max(kPreview_s, (integrator::steady_s() - start_s) / kPreviewShare);
            lock.lock();
            preview_due_s_ = integrator::steady_s() + pause_s;
        }
        const double left_s = std::min(checkpoint_due_s_, preview_due_s_) - integrator::steady_s();
        if (left_s <= 0) monitor_.pause = true;  // the next round waits until it was answered
        const double wait_s = left_s <= 0 ? 0.05 : std::min(left_s, 1.);
        wake_.wait_for(lock, stop, std::chrono::duration<double>(wait_s),
                       [&] { return to_show_.has_value(); });
    }
}

void Keeper::write_preview(const io::Picture& picture) {
    io::write_output(*plan_.preview, picture, plan_.display);
}

void Keeper::attempt(const std::function<void()>& action, bool& told) {
    try {
        action();
    } catch (const std::exception& error) {
        {
            const std::lock_guard lock(mutex_);
            if (std::exchange(told, true)) return;
        }
        plan_.notice(fmt::format("warning: {}; it is tried again", error.what()));
    }
}

}  // namespace petzval::apps
