// SPDX-License-Identifier: Apache-2.0
// The readers of the formats of lenses; io/lens/lens_file.h chooses among them.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "io/base/json_cursor.h"
#include "io/glass/glass_lookup.h"
#include "io/lens/lens_file.h"

namespace petzval::io {

/// Largest numbers of a lens file, so that nothing overflows: a larger radius should be a plane,
/// and no lens is wider.
inline constexpr double kMaxRadius_mm = 1e9, kMaxThickness_mm = 1e5, kMaxSemiDiameter_mm = 1e4;
inline constexpr double kMaxConic = 1e9;
/// Smallest length of a lens file; less is an error in the unit.
inline constexpr double kMinLength_mm = 1e-4;

/// Refuses keys of an object other than these. what: "a lens here".
void allow_keys(const JsonCursor&, std::initializer_list<const char*> keys, const char* what);

/// Readers of each format: they read text from a file of that name and throw InputError. name: of
/// the lens, unless the file says it.
[[nodiscard]] LensFile read_lens_json(std::string_view text, const std::string& file,
                                      const std::string& name, LensGlasses&);
[[nodiscard]] LensFile read_lens_dat(std::string_view text, const std::string& file,
                                     const std::string& name);
[[nodiscard]] LensFile read_lens_zmx(std::string_view text, const std::string& file,
                                     const std::string& name, LensGlasses&);

/// Fault in the lengths of a surface, a text that begins with "has"; nothing where all is well.
[[nodiscard]] std::optional<std::string> fault_of(const camera::LensSurface&);

/// Warning of a stop for which add_stop() is true.
inline constexpr const char* kShapedStop =
    "the stop is a curved surface; the plane through its vertex is taken";
/// Adds the stop behind other surfaces. One that is shaped, or where the glass changes, becomes
/// that surface and a plane through its vertex, as wide as it is and on its side in air, if it has
/// one. Returns whether it is shaped, so that the plane is an approximation.
bool add_stop(std::vector<camera::LensSurface>&, camera::LensSurface stop);
/// Number of the surface whose edge limits the light of a distant point on the axis: its aperture
/// stop (Welford 1986, Aberrations of Optical Systems, ch. 3), by paraxial rays of line d.
[[nodiscard]] size_t limiting_surface(const std::vector<camera::LensSurface>&);

/// Summary of a lens in our JSON, without its surfaces.
[[nodiscard]] LensSummary read_lens_summary(std::string_view text, const std::string& file);

}  // namespace petzval::io
