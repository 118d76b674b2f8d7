// SPDX-License-Identifier: Apache-2.0
// Options of what a render keeps while it runs: states to go on from, and pictures to look at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace petzval {

/// Keep options as given; resolve() reads the texts.
struct KeepOptions {
    std::string checkpoint = "auto";
    std::optional<std::filesystem::path> preview, log;
    bool skip_existing = false;

    std::optional<std::filesystem::path> state;  ///< absent: none is written
    bool state_is_wanted = false;                ///< it stays when the render is complete
    /// State whose samples it goes on from.
    std::optional<std::filesystem::path> resumed_from;
    std::optional<double> checkpoint_s;  ///< what was asked for
};

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_keep_options(CLI::App&, KeepOptions&);

/// Takes the state out of the files to write: it is one of them, or lies beside the first picture.
/// wanted: it is to stay, whatever the files are. Throws CLI::ValidationError.
void resolve(KeepOptions&, std::vector<std::filesystem::path>& outputs, bool wanted);

/// Time between two checkpoints of a state of that size: as asked, or ten minutes for a state that
/// stays anyway or is small enough; nothing where there is none.
[[nodiscard]] std::optional<double> checkpoint_interval_s(const KeepOptions&, uint64_t state_bytes);

/// Takes the states out of the files to write.
[[nodiscard]] std::vector<std::filesystem::path> take_states(
    std::vector<std::filesystem::path>& outputs);

/// Whether a file's name is that of a state.
[[nodiscard]] bool is_state_name(const std::filesystem::path&);

}  // namespace petzval
