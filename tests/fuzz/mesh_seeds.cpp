// SPDX-License-Identifier: Apache-2.0
// Writes valid files that combine what meshes may have, as seeds for the fuzzer:
//
//   mesh_seeds FOLDER COUNT [FIRST]   # FOLDER/combined_FIRST and on
#include <cstdio>
#include <cstdlib>

#include "tests/support/combined/combined_gltf.h"

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fputs("mesh_seeds FOLDER COUNT [FIRST]\n", stderr);
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    const auto first = static_cast<uint32_t>(argc > 3 ? std::atoi(argv[3]) : 0);
    const uint32_t end = first + static_cast<uint32_t>(std::atoi(argv[2]));
    for (uint32_t seed = first; seed < end; ++seed)
        petzval::test::CombinedGltf(seed).save_glb(folder / ("combined_" + std::to_string(seed)));
}
