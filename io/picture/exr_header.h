// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace petzval::io {

/// Reason why the headers of an OpenEXR file cannot be right; empty where they can. OpenEXR takes
/// the memory that an attribute asks for before it looks whether the file is as long: 776 bytes can
/// take 2 GiB.
[[nodiscard]] std::string exr_header_complaint(const std::filesystem::path&);

}  // namespace petzval::io
