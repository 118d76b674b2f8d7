// SPDX-License-Identifier: Apache-2.0
// Opening a configuration of OpenColorIO, which reads files by their names: none of them reaches it
// that is no regular file.
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <vector>

namespace petzval::io {

/// A configuration, and the files that it is read from.
struct OcioConfig {
    OCIO_NAMESPACE::ConstConfigRcPtr config;
    /// The configuration, the lookup tables that its transforms name, and those that the tables
    /// refer to, as far as they are there.
    std::vector<std::filesystem::path> files;
};

/// Opens a configuration. Throws InputError where it cannot be used, and where a file of it is a
/// pipe or a device.
[[nodiscard]] OcioConfig open_ocio_config(const std::filesystem::path&);

}  // namespace petzval::io
