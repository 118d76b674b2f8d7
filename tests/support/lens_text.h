// SPDX-License-Identifier: Apache-2.0
// What tests of readers of lenses share: small files of other programs, and changes of them.
#pragma once

#include <string>
#include <vector>

#include "io/lens/lens_file.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace petzval::test {

inline const char* const kZmx =
    "MODE SEQ\nUNIT MM\nGCAT SCHOTT\nSURF 0\n  DISZ INFINITY\n"
    "SURF 1\n  STOP\n  CURV 0.02\n  DISZ 4\n  GLAS N-BK7 0 0 1.5 40\n  DIAM 10\n"
    "SURF 2\n  TYPE EVENASPH\n  CURV -0.02\n  PARM 1 0\n  PARM 2 1e-6\n  DISZ 3\n  DIAM 10\n"
    "SURF 3\n  COMM a plane in air\n  DISZ 40\n"
    "SURF 4\n  DISZ 0\n";

inline const char* const kDat =
    "# radius thickness index diameter\n50 4 1.5 20\n-50 2 1 20\n0 3 0 15\n60 4 1.6 18\n-60 40 0 "
    "18\n";

/// With the first `from` as `to`; there must be one.
[[nodiscard]] inline std::string with(std::string text, const std::string& from,
                                      const std::string& to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
}

/// What stands in the text, what is put there, and the message.
struct TextFault {
    std::string from, to, message;
};

class LensText : public testing::Test {
  protected:
    io::LensFile read(const std::string& name, const std::string& bytes) {
        write_text(folder_ / name, bytes);
        return io::load_lens((folder_ / name).string());
    }
    std::string refused(const std::string& name, const std::string& text) {
        return refusal([&] { (void)read(name, text); });
    }
    /// Each change of the text must be refused with its message.
    void expect_refused(const std::string& name, const std::string& text,
                        const std::vector<TextFault>& faults) {
        for (const auto& [from, to, message] : faults)
            EXPECT_TRUE(has(refused(name, with(text, from, to)), message)) << to;
    }
    TemporaryFolder folder_;
};

}  // namespace petzval::test
