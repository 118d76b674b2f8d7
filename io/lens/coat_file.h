// SPDX-License-Identifier: Apache-2.0
// Coatings by name, in files of their own, and in lens files. docs/guide/lenses.md describes them.
#pragma once

#include <optional>
#include <string>

#include "camera/lens/layer_stack.h"
#include "io/base/json_cursor.h"

namespace petzval::io {

/// Most layers of a coating.
inline constexpr size_t kMaxLayers = 1000;

/// Layers of the object that holds "layers". Throws InputError with the JSON path for what is no
/// layer, or where there are more than kMaxLayers.
[[nodiscard]] camera::LayerStack read_layers(const JsonCursor&);

/// Coating by its name, whatever the case; nothing where there is none of that name.
[[nodiscard]] std::optional<camera::Coating> coating_named(const std::string& name);

/// Coating of an option: a name, or a file of layers (.json). Throws ArgumentError, which lists the
/// names, where it is neither, and InputError as read_layers() does.
[[nodiscard]] camera::SurfaceCoat read_coat(const std::string& name_or_file);

/// The names of kCoatingNames, with commas between.
[[nodiscard]] std::string coating_names();

}  // namespace petzval::io
