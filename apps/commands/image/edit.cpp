// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/image/edit.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/cli/readers.h"
#include "apps/commands/image/shown.h"
#include "apps/request/file_names.h"
#include "apps/request/parse.h"
#include "apps/state/render_facts.h"
#include "io/base/error.h"
#include "io/image/picture_files.h"
#include "io/image/sheet.h"

namespace petzval {
namespace {

struct SheetRequest {
    std::vector<std::string> in;
    std::string out;
    std::optional<std::string> labels;
    SheetOptions sheet;
    ShownOptions shown;
};

/// Labels as given, one for each picture; without --labels the names of the files.
std::vector<std::string> labels_of(const SheetRequest& o) {
    std::vector<std::string> labels;
    if (!o.labels) {
        for (const std::filesystem::path file : o.in) labels.push_back(file.stem().string());
        return labels;
    }
    for (const std::string_view label : split(*o.labels, ';')) labels.emplace_back(trimmed(label));
    if (labels.size() != o.in.size())
        throw ValueError(
            "--labels",
            fmt::format("{} for {} pictures; give one label for each, separated by semicolons",
                        labels.size(), o.in.size()));
    return labels;
}

void sheet_command(SheetRequest& o) {
    const std::vector<std::string> labels = labels_of(o);
    std::vector<NamedFile> inputs;
    for (const std::string& file : o.in) inputs.push_back({"a picture of the sheet", file});
    begin_showing(o.shown, o.out, inputs);
    check_sheet(o.out, o.sheet);
    ContactSheet sheet(o.in.size(), o.sheet);
    for (size_t i = 0; i < o.in.size(); ++i) {
        PictureBudget one =
            o.shown.order.render.scene.pictures();  // the sheet keeps next to nothing of each
        const Picture picture = read_picture(o.in[i], one);
        sheet.add(shown(picture, o.in[i], o.shown, AlphaUse::Keep), labels[i]);
    }
    sheet.write(o.out, o.shown.display.config.empty());
}

struct CropRequest {
    std::string in, crop, out;
    ShownOptions shown;
};

std::string as_words(const Rect& r) {
    return fmt::format("{},{},{},{}", r.x0, r.y0, r.width(), r.height());
}

/// Pixels of a picture inside a rectangle of its full frame. Throws where it does not hold them.
Picture cut_out(const Picture& from, const Rect& crop, const std::string& file) {
    const Rect held{from.x, from.y, from.x + from.width, from.y + from.height};
    if (crop.x0 < held.x0 || crop.y0 < held.y0 || crop.x1 > held.x1 || crop.y1 > held.y1)
        throw ArgumentError(
            file, "",
            "holds only {} (x,y,width,height) of its {}x{} frame, not all of {}; name "
            "pixels inside that",
            as_words(held), from.full_width, from.full_height, as_words(crop));
    Picture cut{from, {}};
    // It is not the picture that the hash is of.
    std::erase_if(cut.metadata, [](const auto& one) { return one.first == kLightHash; });
    cut.for_display = from.for_display;
    cut.x = crop.x0;
    cut.y = crop.y0;
    cut.width = crop.width();
    cut.height = crop.height();
    const size_t channels = from.channels.size(), count = size_t(cut.width) * channels;
    for (int y = crop.y0; y < crop.y1; ++y) {
        const size_t pixel = size_t(y - held.y0) * size_t(from.width) + size_t(crop.x0 - held.x0);
        const auto row = from.pixels.begin() + std::ptrdiff_t(pixel * channels);
        cut.pixels.insert(cut.pixels.end(), row, row + std::ptrdiff_t(count));
    }
    return cut;
}

/// Throws where a JPEG would show what is transparent in a picture.
void require_opaque(const Picture& picture, const std::string& out) {
    const int alpha = channel_index(picture, "A");
    for (size_t i = size_t(alpha); alpha >= 0 && i < picture.pixels.size();
         i += picture.channels.size())
        if (picture.pixels[i] < 1.f)
            throw ArgumentError(out, "",
                                "the picture is transparent, which JPEG cannot be; write .png");
}

void crop_command(CropRequest& o) {
    begin_showing(o.shown, o.out, {{"the picture to cut", o.in}});
    check_output(o.out, o.shown.display);
    PictureBudget pictures = o.shown.order.render.scene.pictures();
    const Picture whole = read_picture(o.in, pictures);
    const Rect crop = parse_crop("crop", o.crop);
    check_inside("crop", crop, {whole.full_width, whole.full_height});
    const Picture cut = cut_out(whole, crop, o.in);
    const PictureFormat format = picture_format(o.out);
    if (format == PictureFormat::Exr) {
        if (cut.for_display)
            throw ArgumentError(o.out, "",
                                "{} holds values for a display, and EXR holds light; "
                                "write .png or .jpg",
                                o.in);
        return write_exr(o.out, cut);
    }
    if (cut.for_display && format == PictureFormat::Jpeg) require_opaque(cut, o.out);
    const AlphaUse use = format == PictureFormat::Png ? AlphaUse::Keep : AlphaUse::OnBlack;
    // By the whole picture, so that the part looks as it does there.
    if (!cut.for_display) settle_exposure(o.shown, whole);
    write_8bit(o.out, shown(cut, o.in, o.shown, use),
               cut.for_display || o.shown.display.config.empty());
}

}  // namespace

void add_sheet(CLI::App& image) {
    constexpr int kMostPixels = 65535;
    auto options = std::make_shared<SheetRequest>();
    CLI::App* sheet =
        image.add_subcommand("sheet", "put pictures side by side, each with its label");
    sheet->add_option("pictures", options->in, "linear pictures, as .exr, or .png and .jpg")
        ->required();
    sheet->add_option("-o,--output", options->out, "sheet to write, .png or .jpg")
        ->required()
        ->check(complaint_about_display_name);
    sheet->add_option("--labels", options->labels,
                      "texts under the pictures, separated by semicolons (default: names of the "
                      "files)");
    sheet
        ->add_option("--columns", options->sheet.columns,
                     "pictures side by side (default: as many as make the sheet about square)")
        ->transform(whole_number_between(1, kMostPixels));
    sheet
        ->add_option("--cell", options->sheet.cell_width_px,
                     "width of a cell in pixels: wider pictures are reduced (default: as the "
                     "pictures are, but the sheet at most 3840 wide)")
        ->transform(whole_number_between(kLeastCellWidth_px, kMostPixels));
    add_shown_options(*sheet, options->shown);
    sheet->footer(
        "--exposure auto is found from the first linear picture and used for all, so that they can "
        "be compared. PNG and JPEG are shown as they are.");
    sheet->callback([options] { sheet_command(*options); });
}

void add_crop(CLI::App& image) {
    auto options = std::make_shared<CropRequest>();
    CLI::App* crop = image.add_subcommand("crop", "cut a part out of a picture");
    crop->add_option("picture", options->in, "picture, as .exr, .png or .jpg")->required();
    crop->add_option("crop", options->crop, "x,y,width,height in pixels of the full frame")
        ->required();
    crop->add_option("-o,--output", options->out,
                     "picture to write: .exr, with all layers, or .png or .jpg")
        ->required()
        ->check(complaint_about_picture_name);
    add_shown_options(*crop, options->shown);
    crop->callback([options] { crop_command(*options); });
}

}  // namespace petzval
