// SPDX-License-Identifier: Apache-2.0
#include "apps/request/file_names.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/request/value_error.h"
#include "io/base/ascii.h"
#include "io/file/atomic_file.h"
#include "io/picture/picture_kind.h"

namespace petzval::apps {

namespace fs = std::filesystem;

std::string complaint_about_picture_name(const std::string& name) {
    try {
        static_cast<void>(io::picture_format(name));
        return "";
    } catch (const io::InputError& error) {
        return error.what();
    }
}

std::string complaint_about_render_name(const std::string& name) {
    return is_state_name(name) ? "" : complaint_about_picture_name(name);
}

std::string complaint_about_display_name(const std::string& name) {
    const std::string complaint = complaint_about_picture_name(name);
    if (complaint.empty() && !is_for_display(name))
        return name + ": a view is written as .png, .jpg or .jpeg";
    return complaint;
}

bool is_state_name(const fs::path& path) {
    return io::lower(path.extension().string()) == ".state";
}

bool is_for_display(const fs::path& picture) {
    return io::picture_format(picture) != io::PictureFormat::Exr;
}

RenderFiles files_of(const RenderOrder& order) {
    RenderFiles files;
    std::vector<fs::path> states;
    for (const fs::path& output : order.run.outputs)
        (is_state_name(output) ? states : files.pictures).push_back(output);
    if (states.size() > 1) throw ValueError("⟨output⟩", "names two states, and a render has one");
    const Checkpoint& checkpoint = order.run.checkpoint;
    files.state_stays = !states.empty() || order.render.samples.range;
    if (!states.empty()) {
        files.state = states.front();
    } else if (files.state_stays || checkpoint.when != Checkpoint::When::Off) {
        const auto file = std::ranges::find_if_not(
            files.pictures, [](const fs::path& path) { return io::is_stream(path); });
        if (file != files.pictures.end()) files.state = fs::path(*file).replace_extension(".state");
        if (!files.state && files.state_stays)
            throw ValueError("⟨output⟩", "needs a file for the state: ⟨output⟩ NAME.state");
    }
    if (checkpoint.when == Checkpoint::When::Every && !files.state)
        throw ValueError("⟨checkpoint⟩", "needs a file to write: ⟨output⟩ NAME.state");
    return files;
}

fs::path name_of_frame(const std::string& option, const fs::path& path, int frame, bool several) {
    const std::string name = path.filename().string();
    const size_t end = name.find_last_of('#');
    if (end == name.npos) {
        if (!several) return path;
        throw ValueError(
            option,
            fmt::format("\"{}\" names one file for all frames; put #### where their numbers go",
                        path.string()));
    }
    const size_t before = name.find_last_not_of('#', end);
    const size_t begin = before == name.npos ? 0 : before + 1;
    return path.parent_path() / fmt::format("{}{:0{}}{}", name.substr(0, begin), frame,
                                            end + 1 - begin, name.substr(end + 1));
}

void number_files(RunRequest& run, int number, bool several) {
    for (fs::path& output : run.outputs)
        output = name_of_frame("⟨output⟩", output, number, several);
    if (run.stats) run.stats = name_of_frame("⟨stats⟩", *run.stats, number, several);
    if (run.preview) run.preview = name_of_frame("⟨preview⟩", *run.preview, number, false);
}

std::optional<double> checkpoint_interval_s(const Checkpoint& checkpoint, const RenderFiles& files,
                                            uint64_t state_bytes) {
    constexpr double kUsual_s = 600;
    constexpr uint64_t kMostByItself_bytes = 256'000'000;
    if (!files.state || checkpoint.when == Checkpoint::When::Off) return std::nullopt;
    if (checkpoint.when == Checkpoint::When::Every) return checkpoint.s;
    const bool by_itself = files.state_stays || state_bytes < kMostByItself_bytes;
    return by_itself ? std::optional(kUsual_s) : std::nullopt;
}

}  // namespace petzval::apps
