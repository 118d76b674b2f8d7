// SPDX-License-Identifier: Apache-2.0
#include "apps/request/field_kinds.h"
#include "apps/request/field_members.h"
#include "apps/request/field_rows.h"
#include "apps/request/file_names.h"
#include "apps/request/parse.h"
#include "io/base/ascii.h"

namespace petzval::apps {
namespace {

constexpr int kMostViews = 100'000;

std::vector<RequestField> output_fields() {
    RequestField output =
        common(list("output", in::run(&RunRequest::outputs),
                    "picture to write: .exr, .png, .jpg; or .state; may be given more than once",
                    complaint_about_render_name));
    output.short_name = "o";
    output.value = "FILE";
    return {output};
}

std::vector<RequestField> display_fields() {
    return {
        common(parsed("exposure", in::display(&DisplayRequest::exposure),
                      "stops, for PNG and JPEG, or auto; EXR is always scene-linear (default 0)",
                      parse_exposure,
                      [](const ExposureRequest& asked) {
                          return asked.is_auto ? std::string("auto") : fmt::format("{}", asked.ev);
                      })),
        common(text(
            "view", in::display(&DisplayRequest::view),
            "display transform of PNG and JPEG: sRGB (default), ACES, raw; with ⟨ocio⟩ a view of "
            "its default display, or DISPLAY/VIEW")),
        text("ocio", in::display(&DisplayRequest::config),
             "OpenColorIO configuration for PNG and JPEG (default: the one that $OCIO names, else "
             "Petzval's own)")};
}

RequestField layer_field() {
    RequestField field;
    field.name = "aov";
    field.level = FieldLevel::Common;
    field.value = "TEXT";
    field.help = fmt::format("layers of the EXR: {}; may be given more than once",
                             fmt::join(layer_names(), ","));
    field.form = FieldForm::List;
    field.set = [](RenderOrder& order, const std::string& text) {
        add_aovs("⟨aov⟩", text, order.render.layers);
    };
    field.texts = [](const RenderOrder& order) {
        std::vector<std::string> names;
        for (const Aov layer : order.render.layers) names.emplace_back(aov_info(layer).name);
        return names;
    };
    return field;
}

RequestField denoise_field() {
    return common(flag("denoise", in::render(&RenderRequest::denoise), true,
                       "denoise the picture, and say how large its error is; with ⟨noise⟩ render "
                       "until it is below that"));
}

std::vector<RequestField> console_fields() {
    return {text("stats", in::run(&RunRequest::stats), "write counts and times to this JSON file"),
            choice("progress", in::run(&RunRequest::progress),
                   "on stderr: auto (default), bar, lines, json, percent (lines as PROGRESS 37%), "
                   "none")};
}

std::string text_of(const std::vector<int>& frames) {
    if (frames.size() == 1) return fmt::format("{}", frames[0]);
    return fmt::format("{}:{}:{}", frames.front(), frames.back(), frames[1] - frames[0]);
}

std::vector<RequestField> sequence_fields() {
    RequestField frames = common(parsed(
        "frames", in::sequence(&SequenceRequest::frames),
        "frames of ⟨fps⟩, as 1:48 or 1:48:2; #### in the names of files becomes their number",
        parse_frames, [](const std::vector<int>& numbers) { return text_of(numbers); }));
    frames.texts = [](const RenderOrder& order) -> std::vector<std::string> {
        if (order.sequence.frames.empty()) return {};
        return {text_of(order.sequence.frames)};
    };
    return {
        common(frames),
        number("turntable", in::sequence(&SequenceRequest::turntable), {1, kMostViews},
               "this number of views, evenly spaced around the scene"),
        common(parsed("sweep", in::sequence(&SequenceRequest::sweep),
                      "a picture for each value of an option: fstop=1.4,2,2.8 or lens=NAME,NAME",
                      parse_sweep,
                      [](const Sweep& sweep) {
                          return fmt::format("{}={}", sweep.field, fmt::join(sweep.values, ";"));
                      })),
        text("sheet", in::sequence(&SequenceRequest::sheet),
             "all pictures side by side with labels, as .png or .jpg")};
}

std::string text_of(const Checkpoint& checkpoint) {
    if (checkpoint.when == Checkpoint::When::Every) return fmt::format("{}", checkpoint.s);
    return checkpoint.when == Checkpoint::When::Off ? "off" : "auto";
}

Checkpoint parse_checkpoint(const std::string& option, const std::string& text) {
    if (io::lower(text) == "auto") return {};
    if (io::lower(text) == "off") return {Checkpoint::When::Off};
    return {Checkpoint::When::Every, parse_duration_s(option, text)};
}

std::vector<RequestField> keep_fields() {
    return {
        parsed("checkpoint", in::run(&RunRequest::checkpoint),
               "write what there is to NAME.state this often, for petzval resume: 10m; off; auto "
               "(default: every 10m, where that file is below 256 MB or stays anyway)",
               parse_checkpoint, [](const Checkpoint& checkpoint) { return text_of(checkpoint); }),
        text("preview", in::run(&RunRequest::preview),
             "picture, .png or .jpg, that is written anew every few seconds",
             complaint_about_display_name),
        text("log", in::run(&RunRequest::log),
             "file to which all messages are added, with the time"),
        flag("skip-existing", in::run(&RunRequest::skip_existing), true,
             "leave out pictures that are there from the same command and inputs, and go on from "
             "states that are")};
}

}  // namespace

std::vector<RequestField> run_fields() {
    std::vector<RequestField> all;
    const auto add = [&](const char* group, std::vector<RequestField> fields, FieldPart part,
                         uint8_t takers = kRender) {
        for (RequestField& field : in_group(group, takers, std::move(fields), part))
            all.push_back(std::move(field));
    };
    add("Output", output_fields(), FieldPart::Files);
    add("Output", display_fields(), FieldPart::Picture);
    add("Output", {layer_field(), denoise_field()}, FieldPart::Picture);
    add("Output", console_fields(), FieldPart::Files);
    add("", {flag("quiet", in::run(&RunRequest::quiet), true, "print nothing but errors")},
        FieldPart::Files, kPictures | kTrace);
    add("Sequences", sequence_fields(), FieldPart::Files);
    add("Long renders", keep_fields(), FieldPart::Files);
    return all;
}

}  // namespace petzval::apps
