// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/camera/camera_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/named.h"
#include "io/base/printable.h"
#include "io/file/read_file.h"
#include "io/glass/glass_lookup.h"

namespace petzval::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSinglet = "singlet:";

const io::GltfCamera& find_camera(const std::string& wanted, const std::string& scene,
                                  const std::vector<io::GltfCamera>& cameras) {
    std::vector<std::string> names;
    names.reserve(cameras.size());
    for (const io::GltfCamera& camera : cameras) names.push_back(camera.name);
    if (const auto index = io::find_named(wanted, names)) return cameras[*index];
    throw io::ArgumentError(
        scene, "", io::no_such("camera", wanted, names, "the file has none, use ⟨look-at⟩"));
}

std::string extras_of(const io::GltfCamera& camera) {
    return fmt::format("extras.petzval of camera \"{}\"", io::printable(camera.name));
}

// Whether a camera means a file by a name, and not a lens that ships or a shape: by how it is
// written, or there is such a file beside the scene. Nothing is looked for elsewhere.
bool means_file(const std::string& name, const fs::path& beside, bool is_iris) {
    const std::string text = io::lower(name);
    for (const std::string_view prefix :
         {kSinglet, std::string_view("star:"), std::string_view("polygon:")})
        if (text.starts_with(prefix)) return false;
    const std::string ending = fs::path(text).extension().string();
    if (text.find('/') != text.npos) return true;
    if (ending.size() < 2) return false;
    std::error_code none;
    return is_iris || (ending[1] >= 'a' && ending[1] <= 'z') || fs::is_regular_file(beside, none);
}

// What a camera of a scene names: the path of a file, which lies beside the scene, or a name.
std::string beside(const fs::path& scene, io::FileScope scope, const io::GltfCamera& camera,
                   const std::string& name, bool is_iris) {
    const fs::path folder = scene.parent_path(), path = folder / name;
    if (!means_file(name, path, is_iris)) return name;
    const auto refuse = [&](const char* why) {
        return io::InputError(scene.string(), extras_of(camera),
                              fmt::format("\"{}\" {}", io::printable(name), why));
    };
    if (scope == io::FileScope::Confined && !io::lies_within(path, folder))
        throw refuse("lies outside the folder of the scene, and ⟨confine⟩ allows no file there");
    if (fs::path(name).is_absolute())
        throw refuse("is an absolute path, which is not read; put the file beside the scene");
    return path.string();
}

// Takes from the file's camera what the user has not said.
void take_extras(const io::GltfCamera& camera, const std::filesystem::path& scene,
                 io::FileScope scope, CameraRequest& asked) {
    const io::CameraExtras& file = camera.extras;
    if (!asked.lens && file.lens) asked.lens = beside(scene, scope, camera, *file.lens, false);
    if (!asked.sensor_mm) asked.sensor_mm = file.sensor_mm;
    if (asked.lens == "pinhole") return;
    if (!asked.fstop && !asked.lens_radius_m) asked.fstop = file.fstop;
    if (!asked.fstop && !asked.lens_radius_m && !asked.lens) return;
    if (!asked.focus && file.focus_m && !asked.film_distance_mm)
        asked.focus = FocusDistance{*file.focus_m};
    if (!asked.aperture && file.aperture)
        asked.aperture = beside(scene, scope, camera, *file.aperture, true);
}

std::vector<io::AgfCatalog> open_catalogs(const CameraRequest& asked) {
    std::vector<io::AgfCatalog> catalogs;
    for (const auto& file : asked.glasses) catalogs.emplace_back(file);
    return catalogs;
}

SingleLens parse_singlet(const std::string& text, io::LensGlasses& glasses) {
    const auto refuse = [&](const std::string& why) {
        return io::ArgumentError("⟨lens⟩", text,
                                 why +
                                     "; it must read singlet:GLASS[,BENDING] or "
                                     "singlet:GLASS,R1,R2 with radii in mm (inf: flat)");
    };
    if (text.ends_with(',')) throw refuse("nothing follows the last comma");
    std::istringstream words(text.substr(kSinglet.size()));
    std::string name, word;
    std::getline(words, name, ',');
    std::vector<double> numbers;
    bool has_unit = false;
    while (std::getline(words, word, ',')) {
        double value = 0;
        const bool in_mm = word.ends_with("mm");
        has_unit = has_unit || in_mm;
        const char* const last = word.data() + word.size() - (in_mm ? 2 : 0);
        const auto [end, error] = std::from_chars(word.data(), last, value);
        if (error != std::errc() || end != last || std::isnan(value))
            throw refuse(fmt::format("\"{}\" is no number", word));
        numbers.push_back(value);
    }
    if (numbers.size() > 2) throw refuse("has too many numbers");
    SingleLens lens;
    io::FoundGlass found = glasses.named(name);
    if (!found.glass) throw refuse(found.error);
    lens.glass = *std::move(found.glass);
    if (numbers.size() == 1) {
        if (has_unit) throw refuse("the bending has no unit");
        if (!std::isfinite(numbers[0])) throw refuse("the bending must be finite");
        lens.bending = numbers[0];
    }
    if (numbers.size() == 2) {
        if (numbers[0] == 0 || numbers[1] == 0) throw refuse("a radius is 0");
        lens.radii_mm = {numbers[0], numbers[1]};
    }
    return lens;
}

// The angle of view that a lens is scaled to.
std::optional<float> fit_yfov_rad(const CameraRequest& asked, const io::GltfCamera* from) {
    if (asked.fit != Fit::Fov) return std::nullopt;
    if (asked.fov_deg) return *asked.fov_deg * kPi / 180.f;
    if (from) return from->yfov_rad;
    throw io::ArgumentError("⟨fit⟩", "", "no camera gives an angle of view: give ⟨fov⟩ too");
}

Optics optics_of(const CameraRequest& asked, const io::GltfCamera* from, float aspect) {
    if (!asked.lens)
        return asked.fstop || asked.lens_radius_m ? Optics(IdealLens()) : Optics(NoLens());
    if (*asked.lens == "pinhole") return NoLens();
    if (*asked.lens == "thin") return IdealLens();
    const std::vector<io::AgfCatalog> catalogs = open_catalogs(asked);
    io::LensGlasses glasses(catalogs);
    if (asked.lens->starts_with(kSinglet)) return parse_singlet(*asked.lens, glasses);
    return load_lens_for_film(*asked.lens, catalogs, asked.sensor_mm, aspect,
                              fit_yfov_rad(asked, from));
}

// Refuses what only a lens of a prescription can do.
void check_no_prescription(const CameraRequest& asked, bool has_glass) {
    const auto refuse = [](const char* option) {
        throw io::ArgumentError(
            option, "",
            "needs a lens that is traced surface by surface: give ⟨lens⟩ NAME or "
            "FILE");
    };
    if (asked.fit == Fit::Fov) refuse("⟨fit⟩");
    if (asked.coating != camera::Coating::Ideal) refuse("⟨coating⟩");
    if (asked.ghosts == GhostUse::Only) refuse("⟨ghosts⟩ only");
    if (asked.precision != camera::Precision::Float) refuse("⟨lens-precision⟩");
    if (asked.focus_by != camera::FocusBy::Paraxial) refuse("⟨focus-by⟩");
    if (!asked.glasses.empty() && !has_glass) refuse("⟨glasses⟩");
}

void check_pinhole(const CameraRequest& asked) {
    const auto refuse = [](const char* option, const std::string& why) {
        throw io::ArgumentError(option, "", why);
    };
    if (asked.fstop || asked.lens_radius_m)
        refuse("⟨lens⟩", "a pinhole has no iris: leave out ⟨fstop⟩ and ⟨lens-radius⟩");
    if (asked.focus) refuse("⟨focus⟩", "a pinhole has no focus: give ⟨fstop⟩ or ⟨lens-radius⟩ too");
    if (asked.aperture)
        refuse("⟨aperture⟩", "a pinhole has no iris: give ⟨fstop⟩, ⟨lens-radius⟩ or ⟨lens⟩ too");
    if (asked.aperture_scale != camera::ApertureScale::EqualArea || asked.iris_sampling)
        refuse(asked.iris_sampling ? "⟨iris-sampling⟩" : "⟨aperture-scale⟩",
               "a pinhole has no iris: give ⟨fstop⟩, ⟨lens-radius⟩ or ⟨lens⟩ too");
    if (asked.film_distance_mm)
        refuse("⟨film-distance⟩", "a pinhole has no focus: give ⟨fstop⟩ or ⟨lens-radius⟩ too");
    if (asked.exposure == ExposureMode::Photographic)
        refuse("⟨exposure-mode⟩",
               "a pinhole has no iris that says how much light there is: give ⟨fstop⟩ too");
}

void check_thin(const CameraModel& model) {
    const CameraRequest& asked = model.asked;
    const auto* single = std::get_if<SingleLens>(&model.optics);
    if (!asked.fstop && !asked.lens_radius_m)
        throw io::ArgumentError("⟨lens⟩", *asked.lens, "needs ⟨fstop⟩ or ⟨lens-radius⟩");
    const bool focal_given = asked.focal_length_mm || (single && single->radii_mm);
    if (single && single->radii_mm && asked.focal_length_mm)
        throw io::ArgumentError("⟨focal-length⟩", "", "follows from the radii of the singlet");
    if (!asked.film_distance_mm) return;
    if (asked.fov_deg)
        throw io::ArgumentError("⟨fov⟩", "", "follows from ⟨film-distance⟩ and the sensor");
    if (focal_given && asked.focus)
        throw io::ArgumentError("⟨focus⟩", "", "follows from ⟨film-distance⟩ and the focal length");
}

void check_lens(const CameraRequest& asked) {
    if (asked.natural_vignetting)
        throw io::ArgumentError("⟨natural-vignetting⟩", "",
                                "a traced lens always has its own: leave it out");
    if (asked.focal_length_mm || asked.lens_radius_m || asked.film_distance_mm ||
        (asked.fov_deg && asked.fit != Fit::Fov))
        throw io::ArgumentError(
            "⟨lens⟩", *asked.lens,
            "gives the angle of view and the focal length: leave out ⟨fov⟩, "
            "⟨focal-length⟩, ⟨lens-radius⟩ and ⟨film-distance⟩, or say ⟨fit⟩=fov");
}

}  // namespace

void check_camera_files(const fs::path& scene, io::FileScope scope,
                        const std::vector<io::GltfCamera>& cameras) {
    if (scope == io::FileScope::Anywhere) return;
    for (const io::GltfCamera& camera : cameras) {
        const io::CameraExtras& file = camera.extras;
        if (file.lens) static_cast<void>(beside(scene, scope, camera, *file.lens, false));
        if (file.aperture) static_cast<void>(beside(scene, scope, camera, *file.aperture, true));
    }
}

std::string CameraModel::dispersive_lens() const {
    if (asked.dispersion == camera::DispersionMode::Shared) return "";
    if (const auto* lens = std::get_if<LoadedLens>(&optics))
        return lens->disperses() ? lens->name() : "";
    if (const auto* lens = std::get_if<SingleLens>(&optics))
        return lens->glass.index(kLineF_nm) != lens->glass.index(kLineC_nm) ? *asked.lens : "";
    return "";
}

CameraModel choose_camera_model(const CameraRequest& request, const std::filesystem::path& scene,
                                io::FileScope scope, const std::vector<io::GltfCamera>& cameras,
                                float aspect) {
    CameraModel model;
    model.asked = request;
    if (request.name)
        model.from = &find_camera(*request.name, scene.string(), cameras);
    else if (!request.look_at && !request.pose && !cameras.empty())
        model.from = &cameras.front();
    CameraRequest& asked = model.asked;
    if (model.from && model.from->orthographic) {
        if (asked.fstop || asked.lens_radius_m || asked.fov_deg || asked.focal_length_mm ||
            asked.focus || asked.aperture || asked.film_distance_mm || asked.sensor_mm ||
            asked.natural_vignetting || (asked.lens && *asked.lens != "pinhole"))
            throw io::ArgumentError(
                scene.string(), "",
                fmt::format("camera \"{}\" is orthographic: it takes neither a "
                            "lens, its focus, sensor or vignetting, nor an angle "
                            "of view",
                            io::printable(model.from->name)));
    } else if (model.from) {
        take_extras(*model.from, scene, scope, asked);
    }
    try {
        model.optics = optics_of(asked, model.from, aspect);
    } catch (const io::ArgumentError& error) {
        if (request.lens || !asked.lens) throw;
        throw io::InputError(scene.string(), extras_of(*model.from), error.what());
    }
    if (!std::holds_alternative<LoadedLens>(model.optics))
        check_no_prescription(asked, std::holds_alternative<SingleLens>(model.optics));
    if (std::holds_alternative<NoLens>(model.optics))
        check_pinhole(asked);
    else if (std::holds_alternative<LoadedLens>(model.optics))
        check_lens(asked);
    else
        check_thin(model);
    return model;
}

}  // namespace petzval::apps
