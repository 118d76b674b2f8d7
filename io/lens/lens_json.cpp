// SPDX-License-Identifier: Apache-2.0
// Petzval's own format of a lens: docs/guide/lenses.md.
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "camera/lens/lens.h"
#include "io/base/json_cursor.h"
#include "io/base/json_parse.h"
#include "io/file/text_lines.h"
#include "io/lens/coat_file.h"
#include "io/lens/lens_formats.h"

namespace petzval::io {
namespace {

constexpr Range kLength{kMinLength_mm, kMaxRadius_mm}, kFnumber{0.1, 1000}, kField{1e-3, 180};
constexpr Range kIndex{1, 5}, kAbbe{1, 1e4};

void allow(const JsonCursor& at, std::initializer_list<const char*> keys) {
    allow_keys(at, keys, "a lens here");
}

// Text to be shown: in one line, with spaces for control characters.
std::string shown(const JsonCursor& at, const char* key, const std::string& otherwise = "") {
    std::string text = at.text_or(key, otherwise.c_str());
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ' || c == 127) c = ' ';
    return text;
}

std::optional<double> number_if(const JsonCursor& at, const char* key, Range range) {
    return at.has(key) ? std::optional(at.number(key, range)) : std::nullopt;
}

Glass catalogue_glass(const JsonCursor& at, LensGlasses& glasses) {
    FoundGlass found = glasses.named(at.text("glass"));
    if (!found.glass) at.fail("glass", found.error);
    return *std::move(found.glass);
}

std::optional<Glass> read_medium(const JsonCursor& surface, LensGlasses& glasses) {
    surface.require("medium");
    if (surface.value().at("medium").is_null()) return std::nullopt;
    const JsonCursor at = surface.object("medium");
    allow(at, {"glass", "nd", "vd", "n"});
    if (at.has("glass") + at.has("nd") + at.has("n") != 1 || at.has("nd") != at.has("vd"))
        at.fail("must have glass, or nd and vd, or n; air is null");
    if (at.has("glass")) return catalogue_glass(at, glasses);
    if (at.has("n")) return constant_glass(at.number("n", kIndex));
    Glass glass = model_glass(at.number("nd", kIndex), at.number("vd", kAbbe));
    if (!has_index_of_glass(glass))
        at.fail("vd", "is too small for nd: the index is not from 1 to 5 in all the visible");
    return glass;
}

std::vector<std::array<double, 2>> read_asphere(const JsonCursor& surface) {
    std::vector<std::array<double, 2>> terms;
    const auto at = surface.find_object("asphere");
    if (!at) return terms;
    for (const auto& item : at->value().items()) {
        const auto power = finite_number(item.key());
        if (!power || *power < 2 || *power > camera::kMaxAspherePower ||
            item.key() != std::to_string(int(*power)))
            at->fail(item.key(), "is not a power of r; write a whole number from 2 to {}",
                     camera::kMaxAspherePower);
        terms.push_back({*power, at->number(item.key().c_str())});
    }
    std::sort(terms.begin(), terms.end());
    return terms;
}

camera::SurfaceCoat read_surface_coat(const JsonCursor& surface) {
    if (!surface.has("coating")) return camera::Coating::Uncoated;
    if (surface.value().at("coating").is_object()) return read_layers(surface.object("coating"));
    const auto coating = coating_named(surface.text("coating"));
    if (!coating || *coating >= camera::Coating::Filed)
        surface.fail("coating", "must be layers, or one of {}, but neither filed nor year",
                     coating_names());
    return *coating;
}

camera::LensSurface read_surface(const JsonCursor& at, LensGlasses& glasses) {
    allow(at, {"radius", "thickness", "medium", "semi_diameter", "conic", "asphere", "cylinder",
               "coating", "stop"});
    camera::LensSurface surface;
    at.require("radius");
    if (!at.value().at("radius").is_null()) {
        const double radius_mm = at.number("radius", {-kMaxRadius_mm, kMaxRadius_mm});
        if (std::abs(radius_mm) < kMinLength_mm)
            at.fail("radius", "must not be 0; a plane is null");
        surface.curvature_1_mm = 1 / radius_mm;
    }
    surface.conic = at.number_or("conic", 0, {-kMaxConic, kMaxConic});
    surface.asphere = read_asphere(at);
    if (at.has("cylinder")) {
        const std::string axis = at.text("cylinder");
        if (axis != "x" && axis != "y")
            at.fail("cylinder", "must be \"x\" or \"y\": the axis along which it is straight");
        surface.profile = axis == "x" ? camera::Profile::CylinderX : camera::Profile::CylinderY;
    }
    surface.thickness_mm = at.number("thickness", {-kMaxThickness_mm, kMaxThickness_mm});
    surface.semi_diameter_mm = at.number("semi_diameter", {kMinLength_mm, kMaxSemiDiameter_mm});
    at.check_bool("stop");
    surface.stop = at.value().value("stop", false);
    surface.glass = read_medium(at, glasses);
    surface.coat = read_surface_coat(at);
    return surface;
}

std::vector<camera::LensSurface> read_surfaces(const JsonCursor& lens, LensGlasses& glasses) {
    lens.require("surfaces");
    const std::vector<JsonCursor> items = lens.objects("surfaces");
    if (items.empty() || items.size() > kMaxSurfaces)
        lens.fail("surfaces", "must hold 1 to {} surfaces, but holds {}", kMaxSurfaces,
                  items.size());
    std::vector<camera::LensSurface> surfaces;
    const JsonCursor* stop = nullptr;
    for (const JsonCursor& at : items) {
        const auto before = surfaces.empty() ? std::nullopt : surfaces.back().glass;
        surfaces.push_back(read_surface(at, glasses));
        if (at.has("coating") && surfaces.back().glass == before)
            at.fail("coating", "needs another medium on each side of the surface");
        if (!surfaces.back().stop) continue;
        if (stop) at.fail("stop", "is the second; {} is the stop already", stop->path());
        stop = &at;
    }
    return surfaces;
}

// Makes a plane of the stop, and finds it where the file names none. Surfaces behind it may count
// one more than in the file, which the focusing group follows.
void place_stop(const std::string& file, LensFile& out) {
    camera::Prescription& lens = out.lens;
    const auto is_stop = [](const camera::LensSurface& s) { return s.stop; };
    std::vector<camera::LensSurface> filed = std::exchange(lens.surfaces, {});
    const auto named = std::find_if(filed.begin(), filed.end(), is_stop);
    auto number = static_cast<size_t>(named - filed.begin());
    if (named == filed.end()) {
        number = limiting_surface(filed);
        filed[number].stop = true;
        out.warnings.push_back(
            fmt::format("{}: /surfaces: none has \"stop\": true; the iris is at number {}, counted "
                        "from 0, whose edge limits the light of a distant point on the axis",
                        file, number));
    }
    for (camera::LensSurface& surface : filed) {
        if (!surface.stop)
            lens.surfaces.push_back(std::move(surface));
        else if (add_stop(lens.surfaces, std::move(surface)))
            out.warnings.push_back(fmt::format("{}: /surfaces/{}: {}", file, number, kShapedStop));
    }
    if (!lens.focus_group || lens.surfaces.size() == filed.size()) return;
    auto& [first, last] = *lens.focus_group;
    first += first > static_cast<int>(number);
    last += last >= static_cast<int>(number);
}

std::optional<std::array<int, 2>> read_focus_group(const JsonCursor& at, size_t surfaces) {
    if (!at.has("focus_group")) return std::nullopt;
    const auto ends = at.indices("focus_group", surfaces, "surface");
    if (ends.size() != 2 || ends[0] > ends[1])
        at.fail("focus_group", "must be [first, last], counted from 0 in surfaces");
    return std::array{int(ends[0]), int(ends[1])};
}

std::string source_of(const JsonCursor& at) {
    const std::string patent = shown(at, "patent"), source = shown(at, "source");
    return patent + (patent.empty() || source.empty() ? "" : "; ") + source;
}

}  // namespace

void allow_keys(const JsonCursor& at, std::initializer_list<const char*> keys, const char* what) {
    for (const auto& item : at.value().items())
        if (std::find(keys.begin(), keys.end(), item.key()) == keys.end())
            at.fail(item.key(), "is not a key of {}; the keys are {}", what, fmt::join(keys, ", "));
}

LensFile read_lens_json(std::string_view text, const std::string& file, const std::string& name,
                        LensGlasses& glasses) {
    const nlohmann::json json = parse_json(text, file);
    const JsonCursor at(json, file);
    at.require("surfaces");  // before anything of what may be no lens is shown
    allow(at, {"name", "title", "year", "patent", "source", "grade", "notes", "focal_length",
               "fnumber", "field_half_angle_deg", "image_circle", "focus_group", "surfaces"});
    camera::Prescription lens;
    lens.name = shown(at, "name", name);
    lens.title = shown(at, "title");
    lens.source = source_of(at);
    for (const char* key : {"grade", "notes"}) (void)shown(at, key);
    lens.year = static_cast<int>(at.integer_or("year", 0));
    lens.stated_focal_length_mm = number_if(at, "focal_length", kLength);
    lens.stated_fnumber = number_if(at, "fnumber", kFnumber);
    lens.stated_field_half_deg = number_if(at, "field_half_angle_deg", kField);
    lens.image_circle_mm = at.number_or("image_circle", 0, kLength);
    lens.surfaces = read_surfaces(at, glasses);
    lens.focus_group = read_focus_group(at, lens.surfaces.size());
    LensFile out{std::move(lens), {}};
    place_stop(file, out);
    return out;
}

LensSummary read_lens_summary(std::string_view text, const std::string& file) {
    const nlohmann::json json = parse_json(text, file);
    const JsonCursor at(json, file);
    return {at.text("name"),
            at.text("title"),
            at.text("patent"),
            at.text("grade"),
            at.number("focal_length", kLength),
            at.number("fnumber", kFnumber),
            at.number("field_half_angle_deg", kField),
            at.number_or("image_circle", 0, kLength),
            static_cast<int>(at.integer_or("year", 0))};
}

}  // namespace petzval::io
