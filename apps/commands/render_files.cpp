// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cinttypes>

#include "apps/setup/develop.h"
#include "apps/setup/display_setup.h"
#include "apps/setup/input_files.h"
#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "io/picture/seal.h"

namespace petzval::apps {

namespace fs = std::filesystem;

void check_outputs(RenderOrder& order, const RenderFiles& files) {
    SceneRequest& scene = order.render.scene;
    const RunRequest& run = order.run;
    std::vector<io::NamedFile>& outputs = scene.outputs;
    std::vector<fs::path> partials;
    for (const auto& picture : files.pictures) {
        outputs.push_back({"-o", picture});
        const auto partial = io::partial_name(picture);  // which the formats of a name share
        const auto same = [&](const auto& other) { return io::same_file(other, partial); };
        if (std::none_of(partials.begin(), partials.end(), same)) partials.push_back(partial);
    }
    if (run.stats) outputs.push_back({"--stats", *run.stats});
    if (run.preview) outputs.push_back({"--preview", *run.preview});
    if (order.sequence.sheet) outputs.push_back({"--sheet", *order.sequence.sheet});
    if (run.log) outputs.push_back({"--log", *run.log});
    for (const auto& partial : partials)
        outputs.push_back({"the picture of a render that is stopped", partial});
    if (files.state) outputs.push_back({"the state of the render", *files.state});
    const DisplayRequest& asked = order.render.display;
    io::refuse_overwriting(outputs, input_files(scene));
    io::refuse_overwriting(outputs, input_files(asked));
    io::refuse_overwriting(outputs, own_files());
    const Rect crop = pixels_of(order.render.crop, scene.size);
    const io::DisplayOptions display{0, asked.view, asked.config};
    for (const auto& picture : files.pictures)
        io::check_output(picture, display, crop.width(), crop.height());
    if (run.preview) io::check_output(*run.preview, display, crop.width(), crop.height());
    if (files.state) io::check_writable(*files.state);
    if (run.stats) io::check_writable(*run.stats);
}

std::vector<std::string> settle_display(RenderOrder& order, const RenderFiles& files) {
    DisplayRequest& display = order.render.display;
    std::vector<std::string> remarks;
    if (!files.state_stays && !order.sequence.sheet &&
        std::ranges::none_of(files.pictures, is_for_display)) {
        std::vector<std::string> idle;
        if (display.exposure) idle.emplace_back("--exposure");
        if (!display.view.empty()) idle.emplace_back("--view");
        if (!display.config.empty()) idle.emplace_back("--ocio");
        if (idle.empty()) return {};
        remarks.push_back(fmt::format(
            "warning: {}: without effect, as EXR keeps the light; add -o FILE.png, or show the EXR "
            "later by petzval image view",
            fmt::join(idle, ", ")));
    }
    if (std::string told = resolve_display(display); !told.empty())
        remarks.push_back(std::move(told));
    return remarks;
}

std::vector<io::WriteOutcome> write_pictures(const std::vector<fs::path>& outputs,
                                             const io::DisplayOptions& display,
                                             const FinishedFilm& done, bool stopped,
                                             Console& console) {
    std::vector<io::WriteOutcome> outcomes;
    if (stopped)
        outcomes =
            io::write_partial(outputs, develop(done.film, done.samples, done.facts.metadata));
    else
        for (const auto& output : outputs)
            outcomes.push_back(io::write_or_rescue(output, [&](const fs::path& to) {
                io::write_output(to, picture_for(to, done), display);
            }));
    for (const io::WriteOutcome& one : outcomes) {
        if (!one.written())
            console.error(one.message());
        else if (stopped)
            console.notice(fmt::format("stopped: what there is, is in {}", one.wanted.string()));
    }
    return outcomes;
}

bool is_up_to_date(const fs::path& path, const RenderFacts& facts, const io::FilmShape& shape,
                   std::optional<SampleRange> samples) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return false;
    io::Metadata found;
    try {
        found = io::read_metadata(path);
    } catch (const io::InputError&) {  // no picture, or half of one: it is to be written
        return false;
    }
    const auto text = [&](const char* name) {
        for (const auto& [other, value] : found)
            if (const auto* here = std::get_if<std::string>(&value); here && other == name)
                return *here;
        return std::string();
    };
    SampleRange taken;
    if (samples)
        taken = *samples;
    else if (std::sscanf(text(kSamples).c_str(), "%" SCNu32 ":%" SCNu32, &taken.first,
                         &taken.end) != 2)
        return false;
    const bool same = text(kLightHash) == light_hash(facts, shape, taken) &&
                      (io::picture_format(path) == io::PictureFormat::Exr ||
                       text(kDisplayHash) == display_hash(facts.display));
    return same && io::is_as_written(path, text(io::kSealName));
}

}  // namespace petzval::apps
