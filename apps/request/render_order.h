// SPDX-License-Identifier: Apache-2.0
// Order for a render: the picture, or several, their files, and how the render runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/request/render_request.h"

namespace petzval::apps {

/// Percent: lines such as "PROGRESS 37%", for programs that look for one.
enum class ProgressStyle : uint8_t { Auto, Bar, Lines, Json, Percent, None };

/// Largest number of threads of a render.
inline constexpr int kMostThreads = 1024;

/// How often a state is written.
struct Checkpoint {
    enum class When : uint8_t { Auto, Off, Every } when = When::Auto;
    double s = 0;  ///< between two of them, for Every
};

/// Files of a render and how it runs: nothing here changes a pixel.
struct RunRequest {
    std::vector<std::filesystem::path> outputs;  ///< pictures and states to write
    std::optional<std::filesystem::path> stats, preview, log;
    Checkpoint checkpoint;
    bool skip_existing = false;
    int threads = 0;  ///< 0: as many as can run at once
    ProgressStyle progress = ProgressStyle::Auto;
    bool quiet = false;  ///< print nothing but errors
};

/// Values of a field, one for each picture.
struct Sweep {
    std::string field;
    std::vector<std::string> values;
};

/// Pictures that differ in one field.
struct SequenceRequest {
    std::vector<int> frames;       ///< numbers of frames; none: no such sequence
    std::optional<int> turntable;  ///< number of views all around
    std::optional<Sweep> sweep;
    std::optional<std::filesystem::path> sheet;  ///< all pictures side by side

    [[nodiscard]] bool several() const { return !frames.empty() || turntable || sweep; }
};

struct RenderOrder {
    RenderRequest render;
    RunRequest run;
    SequenceRequest sequence;
};

/// Number of threads that a run takes: as asked, or those that can run at once.
[[nodiscard]] int threads_of(const RunRequest&);

/// Throws ValueError where the parts of an order for one picture do not go together.
void check(const RenderOrder&);
/// Throws ValueError where an order does not say which of several pictures it is for.
void check_sequence(const RenderOrder&);

}  // namespace petzval::apps
