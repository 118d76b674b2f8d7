// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace petzval {

/// Bytes of a picture as a writer of files writes it, by a name without folders whose ending says
/// the format: .exr, .png, .jpg. Throws ValueError for another name, InputError where there is no
/// room for it.
[[nodiscard]] std::string saved_file(
    const std::string& name, const std::function<void(const std::filesystem::path&)>& write);

}  // namespace petzval
