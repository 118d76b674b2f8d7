// SPDX-License-Identifier: Apache-2.0
// A program run as a process: its exit code and what it printed.
//
//     const Finished run = run_petzval({"--version"});
//     Process render({"render", ...});           // or: started, signalled, waited for
//     render.signal(SIGINT);
//     const Finished stopped = render.wait();
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace petzval {

struct Finished {
    int exit_code = -1;  ///< of a process that a signal killed: minus the signal
    bool timed_out = false;
    std::string out, err;
};

/// What a process gets beside its arguments.
struct ProcessOptions {
    std::optional<rlim_t> file_size_limit_bytes;
    std::optional<rlim_t> address_space_limit_bytes;
    std::vector<int> ignored_signals;
    std::optional<std::filesystem::path> folder;    ///< to run in
    std::optional<std::filesystem::path> out, err;  ///< in place of what is captured
};

class Process {
  public:
    using Clock = std::chrono::steady_clock;

    /// Starts PETZVAL_PROGRAM, or another program.
    explicit Process(std::vector<std::string> arguments, const ProcessOptions& options = {},
                     const std::string& program = PETZVAL_PROGRAM) {
        for (auto& ends : pipes_)
            if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
        arguments.insert(arguments.begin(), program);
        std::vector<char*> words;
        for (std::string& argument : arguments) words.push_back(argument.data());
        words.push_back(nullptr);
        id_ = fork();
        if (id_ < 0) throw std::runtime_error("no process");
        if (id_ == 0) become(program, words, options);
        for (auto& ends : pipes_) close(ends[1]);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process() {
        if (id_ > 0) {
            kill(id_, SIGKILL);
            waitpid(id_, nullptr, 0);
        }
        for (auto& ends : pipes_) close(ends[0]);
    }

    [[nodiscard]] pid_t id() const { return id_; }
    void signal(int number) const { kill(id_, number); }

    /// Collects output until stderr is as wanted; false where it ends or two minutes pass before.
    bool wait_for_stderr(const std::function<bool(const std::string&)>& wanted) {
        const auto deadline = Clock::now() + std::chrono::minutes(2);
        while (!wanted(done_.err))
            if (Clock::now() > deadline || !collect(100)) return false;
        return true;
    }
    /// The same, until it holds a text.
    bool wait_for_stderr(const std::string& text) {
        return wait_for_stderr(
            [&](const std::string& err) { return err.find(text) != std::string::npos; });
    }

    /// Collects output until the process ends; kills it after two minutes.
    Finished wait() {
        const auto deadline = Clock::now() + std::chrono::minutes(2);
        while (collect(100)) {
            if (Clock::now() < deadline) continue;
            done_.timed_out = true;
            signal(SIGKILL);
        }
        int status = 0;
        waitpid(id_, &status, 0);
        id_ = -1;
        done_.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        return done_;
    }

  private:
    [[noreturn]] void become(const std::string& program, std::vector<char*>& words,
                             const ProcessOptions& options) const {
        const auto redirect = [](const std::optional<std::filesystem::path>& to, int pipe_end,
                                 int descriptor) {
            dup2(to ? open(to->c_str(), O_WRONLY) : pipe_end, descriptor);
        };
        redirect(options.out, pipes_[0][1], STDOUT_FILENO);
        redirect(options.err, pipes_[1][1], STDERR_FILENO);
        const auto limit = [](auto resource, const std::optional<rlim_t>& bytes) {
            const rlimit both{bytes.value_or(0), bytes.value_or(0)};
            if (bytes) setrlimit(resource, &both);
        };
        limit(RLIMIT_FSIZE, options.file_size_limit_bytes);
        limit(RLIMIT_AS, options.address_space_limit_bytes);
        for (const int number : options.ignored_signals) ::signal(number, SIG_IGN);
        if (!options.folder || chdir(options.folder->c_str()) == 0)
            execv(program.c_str(), words.data());
        _exit(127);
    }

    // Reads what is there, waiting a while for it; false once both ends are closed.
    bool collect(int patience_ms) {
        std::array<pollfd, 2> wanted{
            {{open_[0] ? pipes_[0][0] : -1, POLLIN, 0}, {open_[1] ? pipes_[1][0] : -1, POLLIN, 0}}};
        if (!open_[0] && !open_[1]) return false;
        poll(wanted.data(), wanted.size(), patience_ms);
        for (size_t i = 0; i < 2; ++i) {
            if (wanted[i].revents == 0) continue;
            std::array<char, 65536> bytes;
            const ssize_t n = read(pipes_[i][0], bytes.data(), bytes.size());
            if (n > 0) (i == 0 ? done_.out : done_.err).append(bytes.data(), size_t(n));
            if (n == 0) open_[i] = false;
        }
        return true;
    }

    std::array<std::array<int, 2>, 2> pipes_{};  // of stdout and stderr: read end, write end
    std::array<bool, 2> open_{true, true};
    pid_t id_ = -1;
    Finished done_;
};

inline Finished run_petzval(const std::vector<std::string>& arguments,
                            const ProcessOptions& options = {}) {
    return Process(arguments, options).wait();
}

}  // namespace petzval
