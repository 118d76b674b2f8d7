// SPDX-License-Identifier: Apache-2.0
#include "io/build/build.h"

#include <fmt/format.h>
#include <gnu/libc-version.h>

#include <cstdint>

#include "build_facts.h"  // made by sources.cmake
#include "io/file/read_file.h"

namespace petzval::io {

std::string build_description() {
    return fmt::format("sources: {}\ncompiler: {}\nlibraries: glibc {}, {}", kBuildSources,
                       kBuildCompiler, gnu_get_libc_version(), kBuildLibraries);
}

std::string program_version() {
    const std::string text = build_description();
    return fmt::format("petzval {} (build {:016x})", kBuildVersion,
                       fnv1a({reinterpret_cast<const uint8_t*>(text.data()), text.size()}));
}

}  // namespace petzval::io
