// SPDX-License-Identifier: Apache-2.0
// Progress of a render on stderr.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "integrator/render_job.h"

namespace petzval {

enum class ProgressStyle { Auto, Bar, Lines, Json, None };

/// Shows the progress of a render from a thread of its own until it is destroyed.
class Progress {
  public:
    /// total: pixel samples of the whole job; absent where only time bounds it.
    Progress(ProgressStyle, const RenderMonitor&, std::optional<uint64_t> total,
             std::optional<double> time_limit_s);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

  private:
    void watch(const std::stop_token&);
    void show(bool last);

    ProgressStyle style_;
    const RenderMonitor& monitor_;
    std::optional<uint64_t> total_;
    std::optional<double> time_limit_s_;
    std::chrono::steady_clock::time_point start_;
    std::jthread thread_;
};

}  // namespace petzval
