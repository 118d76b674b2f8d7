// SPDX-License-Identifier: Apache-2.0
// Capture of what libraries print on stderr, as lines.
#pragma once

#include <functional>
#include <string>
#include <thread>

namespace petzval::apps {

/// Takes over stderr of the whole process while it lives: each line that anything prints there,
/// libpng say, goes to a function, which a thread of its own calls. Where there is no stderr or no
/// pipe it does nothing.
class StderrCapture {
  public:
    explicit StderrCapture(std::function<void(std::string)> line);
    ~StderrCapture();
    StderrCapture(const StderrCapture&) = delete;
    StderrCapture& operator=(const StderrCapture&) = delete;

    /// Descriptor of the stderr that was there before.
    [[nodiscard]] int before() const { return before_; }

  private:
    void read_lines() const;

    std::function<void(std::string)> line_;
    int before_, from_ = -1;
    std::thread thread_;
};

}  // namespace petzval::apps
