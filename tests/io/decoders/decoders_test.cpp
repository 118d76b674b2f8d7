// SPDX-License-Identifier: Apache-2.0
// The fuzzer's corpus through every reader: files are accepted, or refused with an InputError.
// Under the address and undefined-behaviour sanitizers this keeps mended what the fuzzer found.
#include <gtest/gtest.h>

#include <random>

#include "tests/support/combined/combined_gltf.h"
#include "tests/support/decoders.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_mutation.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;
using test::decoders;

const fs::path kCorpus = fs::path(PETZVAL_TEST_DATA) / "corpus";

/// Files of a reader, by name: the order of a folder is not the same everywhere.
std::vector<fs::path> files_of(const std::string& reader) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(kCorpus / reader)) files.push_back(entry);
    std::sort(files.begin(), files.end());
    return files;
}

TEST(Decoders, AcceptOrRefuseTheCorpus) {
    const test::TemporaryFolder folder;
    for (const auto& [name, decoder] : decoders()) {
        int accepted = 0;
        for (const fs::path& file : files_of(name)) {
            SCOPED_TRACE(file);
            EXPECT_NO_THROW(accepted +=
                            test::is_accepted(decoder, test::read_bytes(file), folder.path()));
        }
        EXPECT_GT(accepted, 0) << name;
    }
}

/// Changes bytes of a file several times, and gives each to a reader.
void expect_no_crash(const test::Decoder& decoder, const std::vector<uint8_t>& bytes,
                     const fs::path& folder, std::mt19937& random) {
    for (int i = 0; i < 8; ++i) {
        const std::string changed = test::mutated({bytes.begin(), bytes.end()}, random);
        SCOPED_TRACE("change " + std::to_string(i));
        EXPECT_NO_THROW((void)test::is_accepted(
            decoder, {reinterpret_cast<const uint8_t*>(changed.data()), changed.size()}, folder));
    }
}

TEST(Decoders, AcceptOrRefuseChangedFiles) {
    const test::TemporaryFolder folder;
    std::mt19937 random(12);
    for (const auto& [name, decoder] : decoders())
        for (const fs::path& file : files_of(name)) {
            SCOPED_TRACE(file);
            expect_no_crash(decoder, test::read_bytes(file), folder.path(), random);
        }
}

TEST(Decoders, AcceptOrRefuseChangedFilesThatCombineWhatMeshesMayHave) {
    const test::TemporaryFolder folder, of_sound;
    std::mt19937 random(13);
    const auto& decoder = decoders().at("glb");
    for (uint32_t seed = 1000; seed < 1030; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto path = test::CombinedGltf(seed).save_glb(of_sound.path() / "sound.glb");
        const std::vector<uint8_t> bytes = test::read_bytes(path);
        EXPECT_TRUE(test::is_accepted(decoder, bytes, folder.path()));
        expect_no_crash(decoder, bytes, folder.path(), random);
    }
}

}  // namespace
}  // namespace petzval::io
