// SPDX-License-Identifier: Apache-2.0
// Options of what is read for a scene, and how much memory it may take.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "apps/cli/time_options.h"
#include "io/gltf/choices.h"
#include "io/gltf/validate/source.h"
#include "io/picture/picture_budget.h"

namespace CLI {
class App;
}

namespace petzval {

/// Reading options as given.
struct ReadingOptions {
    std::string max_memory;
    bool confine = false;
    GltfChoices choices;  ///< without the time, which is in `time`
    TimeOptions time;

    [[nodiscard]] FileScope scope() const {
        return confine ? FileScope::Confined : FileScope::Anywhere;
    }
    /// Choices with the time. Throws CLI::ValidationError.
    [[nodiscard]] GltfChoices all_choices() const;
    /// Bytes of --max-memory; absent where it is not given. Throws CLI::ValidationError.
    [[nodiscard]] std::optional<uint64_t> memory_bytes() const;
    /// Budget for decoded pictures that follows from it. Throws CLI::ValidationError.
    [[nodiscard]] PictureBudget pictures() const;
};

/// Declares --max-memory for a command that reads pictures; it writes to the argument, which must
/// outlive the parsing.
void add_memory_option(CLI::App&, ReadingOptions&);
/// Declares --max-memory, --confine and what may be chosen of a file, for a command that reads a
/// scene, likewise.
void add_reading_options(CLI::App&, ReadingOptions&);

/// Largest number of threads that --threads takes.
inline constexpr int kMostThreads = 1024;
/// Number of threads where none is given: those that can run at once.
[[nodiscard]] int usual_threads();

}  // namespace petzval
