// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/keep_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/cli/output_checks.h"
#include "apps/cli/parse.h"
#include "io/base/ascii.h"
#include "io/base/atomic_file.h"

namespace petzval {

namespace fs = std::filesystem;

void add_keep_options(CLI::App& app, KeepOptions& o) {
    const auto add = [&](const char* name, auto& value, const char* help) {
        return app.add_option(name, value, help)->group("Long renders");
    };
    add("--checkpoint", o.checkpoint,
        "write what there is to NAME.state this often, for petzval resume: 10m; off; auto "
        "(default: every 10m, where that file is below 256 MB or stays anyway)");
    add("--preview", o.preview, "picture, .png or .jpg, that is written anew every few seconds")
        ->check(complaint_about_display_name);
    add("--log", o.log, "file to which all messages are added, with the time");
    app.add_flag("--skip-existing", o.skip_existing,
                 "leave out pictures that are there from the same command and inputs, and go on "
                 "from states that are")
        ->group("Long renders");
}

bool is_state_name(const fs::path& path) {
    return lower(path.extension().string()) == ".state";
}

std::vector<fs::path> take_states(std::vector<fs::path>& outputs) {
    const auto states = std::stable_partition(
        outputs.begin(), outputs.end(), [](const fs::path& path) { return !is_state_name(path); });
    std::vector<fs::path> taken(states, outputs.end());
    outputs.erase(states, outputs.end());
    return taken;
}

void resolve(KeepOptions& o, std::vector<fs::path>& outputs, bool wanted) {
    const std::vector<fs::path> states = take_states(outputs);
    if (states.size() > 1)
        throw CLI::ValidationError("-o", "names two states, and a render has one");
    const bool off = lower(o.checkpoint) == "off";
    if (!states.empty()) {
        o.state = states.front();
        wanted = true;
    } else if (wanted || !off) {
        const auto file = std::find_if_not(outputs.begin(), outputs.end(),
                                           [](const fs::path& path) { return is_stream(path); });
        if (file != outputs.end()) o.state = fs::path(*file).replace_extension(".state");
        if (!o.state && wanted)
            throw CLI::ValidationError("-o", "needs a file for the state: -o NAME.state");
    }
    o.state_is_wanted = wanted;
    if (off || lower(o.checkpoint) == "auto") return;
    o.checkpoint_s = parse_duration_s("--checkpoint", o.checkpoint);
    if (!o.state)
        throw CLI::ValidationError("--checkpoint", "needs a file to write: -o NAME.state");
}

std::optional<double> checkpoint_interval_s(const KeepOptions& o, uint64_t state_bytes) {
    constexpr double kUsual_s = 600;
    constexpr uint64_t kMostByItself_bytes = 256'000'000;
    if (!o.state) return std::nullopt;
    if (o.checkpoint_s) return o.checkpoint_s;
    const bool by_itself =
        lower(o.checkpoint) == "auto" && (o.state_is_wanted || state_bytes < kMostByItself_bytes);
    return by_itself ? std::optional(kUsual_s) : std::nullopt;
}

}  // namespace petzval
