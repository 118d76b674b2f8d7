// SPDX-License-Identifier: Apache-2.0
#include "io/lens/lens_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "camera/lens/lens.h"
#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/nearest.h"
#include "io/file/assets.h"
#include "io/file/text_lines.h"
#include "io/lens/lens_formats.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;

// Files of the lenses that ship, by name.
std::vector<fs::path> shipped() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(asset("lenses")))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

fs::path find_file(const std::string& name_or_file) {
    std::vector<std::string> names;
    for (const fs::path& file : shipped()) {
        names.push_back(file.stem().string());
        if (names.back() == lower(name_or_file)) return file;
    }
    std::error_code none;
    if (!fs::exists(name_or_file, none))
        throw ArgumentError(name_or_file, "",
                            "is neither a file nor a lens" +
                                did_you_mean_or("the lenses are", name_or_file, names));
    return name_or_file;
}

LensFile read(const fs::path& path, LensGlasses& glasses) {
    const std::string file = path.string(), name = path.stem().string();
    const std::string ending = lower(path.extension().string());
    if (ending == ".json") return read_lens_json(text_of_file(path), file, name, glasses);
    if (ending == ".dat") return read_lens_dat(text_of_file(path), file, name);
    if (ending == ".zmx") return read_lens_zmx(text_of_file(path), file, name, glasses);
    throw ArgumentError(file, "", "is not a lens by its ending, which must be .json, .dat or .zmx");
}

// Checks the bounds that all formats share.
void check_size(const camera::Prescription& lens, const std::string& file) {
    std::vector<Glass> different;
    for (const camera::LensSurface& surface : lens.surfaces)
        if (surface.glass &&
            std::find(different.begin(), different.end(), *surface.glass) == different.end())
            different.push_back(*surface.glass);
    if (lens.surfaces.size() > kMaxSurfaces || different.size() > size_t(camera::kMaxMedia) - 1)
        throw InputError(file, "", "has {} surfaces and {} glasses; a lens may have {} and {}",
                         lens.surfaces.size(), different.size(), kMaxSurfaces,
                         camera::kMaxMedia - 1);
}

}  // namespace

LensFile load_lens(const std::string& name_or_file, std::span<const AgfCatalog> catalogs) {
    const fs::path path = find_file(name_or_file);
    LensGlasses glasses(catalogs);
    LensFile lens = read(path, glasses);
    check_size(lens.lens, path.string());
    return lens;
}

LensFile parse_lens(std::string_view json, const std::string& name) {
    LensGlasses glasses({});
    LensFile lens = read_lens_json(json, name, name, glasses);
    check_size(lens.lens, name);
    return lens;
}

std::string text_of_shipped(const std::string& name) {
    for (const fs::path& file : shipped())
        if (file.stem() == lower(name)) return text_of_file(file);
    throw ArgumentError(name, "", "is no lens that ships; petzval lens list names them");
}

std::vector<LensSummary> list_lenses() {
    std::vector<LensSummary> lenses;
    for (const fs::path& file : shipped())
        lenses.push_back(read_lens_summary(text_of_file(file), file.string()));
    return lenses;
}

std::optional<std::string> fault_of(const camera::LensSurface& surface) {
    if (!(std::abs(surface.curvature_1_mm) * kMinLength_mm <= 1))
        return "has a radius that is too small; give it in mm";
    if (!(std::abs(surface.conic) <= kMaxConic)) return "has a conic constant that is too large";
    if (!(std::abs(surface.thickness_mm) <= kMaxThickness_mm))
        return fmt::format("has a thickness of {} mm; it may be {}", surface.thickness_mm,
                           kMaxThickness_mm);
    if (!(surface.semi_diameter_mm >= kMinLength_mm &&
          surface.semi_diameter_mm <= kMaxSemiDiameter_mm))
        return fmt::format("has an aperture of {} mm in diameter; it must be from {} to {}",
                           2 * surface.semi_diameter_mm, 2 * kMinLength_mm,
                           2 * kMaxSemiDiameter_mm);
    return std::nullopt;
}

}  // namespace petzval::io
