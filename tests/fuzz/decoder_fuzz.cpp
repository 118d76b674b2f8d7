// SPDX-License-Identifier: Apache-2.0
// The readers of files under libFuzzer, with the address and undefined-behaviour sanitizers: each
// file is accepted, or refused with an InputError, in bounded time and memory. Needs clang:
//
//   cmake --preset fuzz && cmake --build build-fuzz --target decoder_fuzz mesh_seeds
//   tests/fuzz/run.sh SECONDS       # every reader in turn, from the corpus in tests/data/corpus
//
// FUZZ_READER=gltf build-fuzz/bin/decoder_fuzz FILE repeats one file.
#include <cstdlib>

#include "tests/support/decoders.h"
#include "tests/support/tiny_gltf.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const char* const name = std::getenv("FUZZ_READER");
    static const auto& decoder = petzval::test::decoders().at(name ? name : "gltf");
    static const petzval::TempFolder folder;
    (void)petzval::test::is_accepted(decoder, {data, size}, folder.path);
    return 0;
}
