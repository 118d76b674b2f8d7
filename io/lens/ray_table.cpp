// SPDX-License-Identifier: Apache-2.0
#include "io/lens/ray_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/base/error.h"
#include "io/file/csv.h"

namespace petzval::io {
namespace {

constexpr std::array<const char*, 7> kColumns{"x", "y", "z", "dx", "dy", "dz", "nm"};
constexpr double kFarthest_mm = 1e9;

/// In the order of RayStatus.
constexpr std::array<const char*, 4> kStatuses{"ok", "vignetted", "tir", "miss"};

std::array<size_t, 7> places_of_columns(const CsvTable& table) {
    std::array<size_t, 7> places{};
    for (size_t i = 0; i < kColumns.size(); ++i) {
        const auto at = std::find(table.names.begin(), table.names.end(), kColumns[i]);
        if (at == table.names.end() || table.names.size() != kColumns.size())
            throw InputError(table.file, "", "must have the columns {}, and no others",
                             fmt::join(kColumns, ","));
        places[i] = static_cast<size_t>(at - table.names.begin());
    }
    return places;
}

}  // namespace

std::vector<RayToTrace> read_rays(const std::filesystem::path& path) {
    const CsvTable table = read_csv(path);
    const auto places = places_of_columns(table);
    std::vector<RayToTrace> rays;
    for (size_t row = 0; row < table.rows.size(); ++row) {
        const auto cell = [&](size_t i) { return table.rows[row][places[i]]; };
        const auto refuse = [&](const std::string& message) {
            return InputError(table.file, table.place(row), message);
        };
        const RayToTrace ray{{cell(0), cell(1), cell(2)}, {cell(3), cell(4), cell(5)}, cell(6)};
        for (size_t i = 0; i < 6; ++i)
            if (std::abs(cell(i)) > kFarthest_mm)
                throw refuse(fmt::format("{} is {:g}; it may be {:g} at most", kColumns[i], cell(i),
                                         kFarthest_mm));
        if (!(ray.direction.length() > 1e-9))
            throw refuse("dx,dy,dz has no length; give a direction");
        if (ray.nm < kFirst_nm || ray.nm > kLast_nm)
            throw refuse(
                fmt::format("nm is {:g}; it must be from {} to {}", ray.nm, kFirst_nm, kLast_nm));
        rays.push_back(ray);
    }
    return rays;
}

std::string ray_table(std::span<const camera::TracedRay> rays, camera::Towards towards,
                      double film_mm) {
    std::string out = "x,y,z,dx,dy,dz,film_x,film_y,path,status,surface\n";
    for (const camera::TracedRay& ray : rays) {
        if (ray.status != camera::RayStatus::Passed) {
            out += fmt::format(",,,,,,,,,{},{}\n", kStatuses[static_cast<size_t>(ray.status)],
                               ray.end_surface);
            continue;
        }
        const auto film = towards == camera::Towards::Film ? ray.at_plane(film_mm) : std::nullopt;
        out += fmt::format("{},{},{},{},{},{},{},{},ok,\n", ray.point.x, ray.point.y, ray.point.z,
                           ray.direction.x, ray.direction.y, ray.direction.z,
                           film ? fmt::format("{},{}", (*film)[0], (*film)[1]) : ",", ray.path_mm);
    }
    return out;
}

}  // namespace petzval::io
