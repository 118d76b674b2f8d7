// SPDX-License-Identifier: Apache-2.0
// The glTF extensions that Petzval knows. The one table: checks, warnings and `info` follow from
// it, and README.md's table must agree with it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/base/json_cursor.h"

namespace petzval::io {

/// Support of an extension.
enum class ExtensionUse : uint8_t {
    Rendered,      ///< as its text says
    Approximated,  ///< with a difference that is named
    Harmless,      ///< ignored; no picture differs
    Ignored,       ///< ignored, also where the file requires it; the picture differs as named
    Needed         ///< ignored where the file has something to fall back on, else refused
};

struct GltfExtension {
    std::string_view name;
    ExtensionUse use;
    /// Approximated, Ignored, Needed: what that does to the picture. Harmless: why it does nothing.
    std::string_view effect;
    /// Keys that lead to the objects, or arrays of objects, that may have it, separated by spaces:
    /// "root" is the document itself, "*Texture" any key with that ending. Empty: anywhere.
    std::string_view places;
};

/// All of them, in the order of their names.
[[nodiscard]] std::span<const GltfExtension> gltf_extensions();
/// The extension of that name; null where Petzval does not know it.
[[nodiscard]] const GltfExtension* find_gltf_extension(std::string_view name);

/// An extension that a file lists.
struct ExtensionInFile {
    std::string name;  ///< as in the file
    /// Needed where the file requires it: then it is refused. Unknown ones are Ignored, or Needed.
    ExtensionUse use;
    std::string effect;    ///< as in the table; where it is refused, what to do
    uint64_t objects = 0;  ///< that have it
    bool required = false;

    [[nodiscard]] bool refused() const { return required && use == ExtensionUse::Needed; }
};

/// Advice about a file that cannot be shown without an extension that is not supported.
[[nodiscard]] std::string_view gltf_extension_advice(std::string_view name);

/// KHR_meshopt_compression of a buffer or a bufferView, or else EXT_meshopt_compression, which is a
/// part of the first, with the same members.
[[nodiscard]] std::optional<JsonCursor> meshopt_extension(const JsonCursor& owner);

}  // namespace petzval::io
