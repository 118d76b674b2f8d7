// SPDX-License-Identifier: Apache-2.0
// Wavelength data of a glTF file: KHR_materials_dispersion, and Petzval's own extras,
//     "extras": {"petzval": {"glass": "schott:N-SF11"}}
// A material may name a glass, a metal or a reflectance, and an illuminant; a punctual light an
// illuminant.
#pragma once

#include <map>
#include <string>

#include "core/scene/scene.h"
#include "io/base/json_cursor.h"
#include "io/gltf/document/tally.h"

namespace petzval::io {

/// Looks up what the file names, and adds metals, reflectances and illuminants to the scene,
/// each once. Throws InputError with the JSON path for a name that is in no catalogue.
class GltfSpectral {
  public:
    GltfSpectral(Scene&, GltfTally&);

    /// Sets a material's glass, metal, reflectance and illuminant, and what follows from them
    /// (index, base colour), once everything else in it is set. Reflectances: those of the file.
    void apply(const JsonCursor& json, const std::map<std::string, MeasuredReflectance>&,
               Material&);
    /// Index in the scene of the illuminant that extras.petzval names; -1 where it names none.
    [[nodiscard]] int32_t illuminant(const JsonCursor& owner);

  private:
    void apply_dispersion(const JsonCursor& json, Material&);
    void apply_glass(const JsonCursor& extras, Material&);
    void apply_metal(const JsonCursor& extras, Material&);
    void apply_reflectance(const JsonCursor& extras, const MeasuredReflectance&, Material&);
    [[nodiscard]] const Glass& glass(const JsonCursor& extras);

    Scene& scene_;
    GltfTally& tally_;
    // Caches: reading a table takes a millisecond, and materials may be many.
    std::map<std::string, Glass> glasses_;         ///< by name as the file has it
    std::map<int32_t, Rgb> metal_colours_;         ///< by place in the scene
    std::map<std::string, int32_t> reflectances_;  ///< places in the scene
};

}  // namespace petzval::io
