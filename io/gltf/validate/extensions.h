// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace petzval {

/// The glTF extensions that Petzval honours. The one list: checks, loader and `info` read it here.
[[nodiscard]] std::span<const std::string_view> supported_gltf_extensions();

[[nodiscard]] bool is_supported_gltf_extension(std::string_view name);

}  // namespace petzval
