// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "apps/request/field_kinds.h"
#include "apps/request/field_members.h"
#include "apps/request/field_rows.h"
#include "apps/request/parse.h"

namespace petzval::apps {
namespace {

constexpr uint8_t kAll = kPictures | kInfo;
constexpr NumberRange kSeeds{0, double(std::numeric_limits<uint32_t>::max())};

std::string no_complaint(const std::string&) {
    return "";
}

RequestField argument(RequestField field) {
    field.form = FieldForm::Argument;
    return field;
}

RequestField spp_field() {
    RequestField field;
    field.name = "spp";
    field.value = "NUMBER";
    field.help =
        "samples of each pixel (default 64); or A:B: only these of them, and their sums in "
        "NAME.state, for petzval merge";
    field.between = ':';
    field.set = [](RenderOrder& order, const std::string& text) {
        SampleRequest& samples = order.render.samples;
        samples.count.reset();
        samples.range.reset();
        if (text.find(':') == text.npos)
            samples.count = uint32_t(parse_whole_number("⟨spp⟩", text, 1, kMostSamples));
        else
            samples.range = parse_samples("⟨spp⟩", text, kMostSamples);
    };
    field.texts = [](const RenderOrder& order) -> std::vector<std::string> {
        const SampleRequest& samples = order.render.samples;
        if (samples.range) return {fmt::format("{}:{}", samples.range->first, samples.range->end)};
        if (samples.count) return {fmt::format("{}", *samples.count)};
        return {};
    };
    return field;
}

std::vector<RequestField> sample_fields() {
    return {
        common(spp_field()),
        common(parsed("noise", in::samples(&SampleRequest::noise),
                      "render until each part of the picture has at most this noise: 2%; ⟨spp⟩ "
                      "(default 4096) and ⟨time-limit⟩ bound it",
                      parse_share, [](double share) { return fmt::format("{}", share); })),
        common(
            parsed("time-limit", in::samples(&SampleRequest::time_limit_s),
                   "render for this long: 60s, 10m, 1h30m, 1:30; with ⟨spp⟩ whichever ends first",
                   parse_duration_s, [](double s) { return fmt::format("{}", s); })),
        number("seed", in::samples(&SampleRequest::seed), kSeeds, "another seed, another noise")};
}

std::vector<RequestField> size_fields() {
    return {
        common(with_between(
            parsed("size", in::scene(&SceneRequest::size),
                   "WIDTHxHEIGHT in pixels (default 1280x720; of a chart 192x108)", parse_size,
                   [](V2i size) { return fmt::format("{}x{}", size.x, size.y); }),
            'x')),
        parsed(
            "crop", in::render(&RenderRequest::crop),
            "x,y,width,height: only these pixels of the full frame; I/N: the I-th of N bands, as "
            "machines share a picture",
            parse_crop, [](const Crop& crop) { return text_of(crop); })};
}

std::vector<RequestField> file_fields() {
    return {
        text("variant", in::file(&io::GltfChoices::variant),
             "variant of the file's materials, by name or index (petzval info lists them)",
             no_complaint),
        text("scene", in::file(&io::GltfChoices::scene),
             "scene of the file, by name or number (default: the one that it names)", no_complaint),
        method(
            number("point-line-radius", in::file(&io::GltfChoices::point_line_radius_m),
                   {1e-9, 1e9, kMetres},
                   "draw the file's points as spheres and its lines as cylinders of this radius: "
                   "2mm, 0.01 (default: they are skipped)"))};
}

std::vector<RequestField> time_fields() {
    return {
        common(parsed(
            "at", in::moment(&MomentRequest::at),
            "moment of the file's animations: 1.25s, 40ms, frame:30 (default: the pose that "
            "the file stores)",
            parse_moment,
            [](Moment at) { return fmt::format("{}{}", at.is_frame ? "frame:" : "", at.value); })),
        number("fps", in::moment(&MomentRequest::fps), {1e-3, 1e6},
               "frames in a second (default 24)"),
        list("animation", in::moment(&MomentRequest::animations),
             "animation that is played, by name or number; may be given again (default: all "
             "that do not contradict an earlier one)",
             no_complaint),
        flag("loop", in::moment(&MomentRequest::loop), true,
             "an animation begins anew at its end (default: it stays as it ends)")};
}

std::vector<RequestField> machine_fields() {
    return {number("threads", in::run(&RunRequest::threads), {1, kMostThreads},
                   "default: one for each core that can be had")};
}

std::vector<RequestField> reading_fields() {
    return {
        parsed("max-memory", in::scene(&SceneRequest::picture_memory_bytes),
               "memory for decoded pictures, as 512MB or 8GB (default: half of what the machine "
               "or its control group has)",
               parse_memory_bytes,
               [](uint64_t bytes) {
                   return bytes % 1000 == 0 ? fmt::format("{}kB", bytes / 1000)
                                            : fmt::format("{}KiB", double(bytes) / 1024);
               }),
        flag("confine", in::scene(&SceneRequest::scope), io::FileScope::Confined,
             "refuse files that the scene names outside its own folder")};
}

}  // namespace

std::vector<RequestField> frame_fields() {
    std::vector<RequestField> all;
    const auto add = [&](const char* group, uint8_t takers, std::vector<RequestField> fields,
                         FieldPart part = FieldPart::Picture) {
        for (RequestField& field : in_group(group, takers, std::move(fields), part))
            all.push_back(std::move(field));
    };
    add("", kAll,
        {argument(common(text("file", in::scene(&SceneRequest::scene), "glTF scene, .gltf or .glb",
                              no_complaint)))});
    add("", kRender, sample_fields());
    add("", kPictures, {size_fields()[0]});
    add("", kRender | kChart, {size_fields()[1]});
    add("", kRender | kPlan,
        {parsed("tolerance", in::render(&RenderRequest::tolerance),
                "error that what is chosen for you may bring: 1% (default) or 0.01", parse_share,
                [](double share) { return fmt::format("{}", share); })});
    add("", kPictures, machine_fields(), FieldPart::Run);
    add("", kAll, reading_fields(), FieldPart::Run);
    add("", kAll, file_fields());
    add("Time", kAll, time_fields());
    return all;
}

}  // namespace petzval::apps
