// SPDX-License-Identifier: Apache-2.0
// Contents of a glTF file, in numbers and in words.
#pragma once

#include "io/gltf/document/model.h"
#include "io/gltf/document/tally.h"
#include "io/gltf/gltf.h"

namespace petzval::io {

/// Counts what a file holds. scene: what the loader made of it.
[[nodiscard]] GltfSummary summarise(const GltfModel&, const GltfTally&, const Scene&);

/// Fills holds, contents, honoured, ignored and remarks, and appends one warning for each kind of
/// trouble counted.
void describe(const GltfModel&, const GltfTally&, const std::optional<AnimationChoice>&, GltfFile&);

/// Support of an extension in one word: rendered, approximated, ignored or refused.
[[nodiscard]] std::string word_of(const ExtensionInFile&);
/// One line for each extension: its name, what becomes of it, and what that does to the picture.
[[nodiscard]] std::vector<std::string> table_of(const std::vector<ExtensionInFile>&);

}  // namespace petzval::io
