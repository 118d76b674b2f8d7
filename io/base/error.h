// SPDX-License-Identifier: Apache-2.0
// The exceptions that io throws: something outside the program is not as it must be. In messages
// the name of a field of a request stands as ⟨focus⟩; who shows them to a user writes it as that
// user types it (apps/request/option_text.h).
#pragma once

#include <fmt/format.h>

#include <new>
#include <stdexcept>
#include <string>

namespace petzval::io {

/// Fault in what the user gave. what() reads "FILE: PLACE: MESSAGE", or "FILE: MESSAGE" where the
/// place is the whole file. place: a JSON path such as /accessors/3/byteOffset, or a line. message:
/// what is wrong and what to do about it, one line, no full stop.
class InputError : public std::runtime_error {
  public:
    InputError(const std::string& file, const std::string& place, const std::string& message)
        : std::runtime_error(file + ": " + (place.empty() ? "" : place + ": ") + message) {}
    /// Likewise with a message that holds values: as fmt::format() takes it.
    template <class Value, class... More>
    InputError(const std::string& file, const std::string& place,
               fmt::format_string<Value, More...> message, Value&& value, More&&... more)
        : InputError(
              file, place,
              fmt::format(message, std::forward<Value>(value), std::forward<More>(more)...)) {}

  protected:
    explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

/// File that cannot be written: a full disk, a folder that is not there.
class OutputError : public InputError {
  public:
    using InputError::InputError;
    /// Several files: the message names them.
    explicit OutputError(const std::string& message) : InputError(message) {}
};

/// Memory that ran out, or would. what(): the message, which names the file or option that asks for
/// more than there is.
class OutOfMemory : public std::bad_alloc {
  public:
    explicit OutOfMemory(const std::string& message) : message_(message) {}
    [[nodiscard]] const char* what() const noexcept override { return message_.what(); }

  private:
    std::runtime_error message_;  // copies without an exception, as a string might not
};

/// Calls f; where memory runs out in it, the OutOfMemory names the file that it was for.
template <class F>
decltype(auto) naming_file(const std::string& file, const F& f) {
    try {
        return f();
    } catch (const OutOfMemory&) {
        throw;  // it has a name
    } catch (const std::bad_alloc&) {
        throw OutOfMemory(file + ": out of memory; it asks for more than there is");
    }
}

/// Request that a sound file cannot meet: a camera name that it does not have, say.
class ArgumentError : public InputError {
  public:
    using InputError::InputError;
};

}  // namespace petzval::io
