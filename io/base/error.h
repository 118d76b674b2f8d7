// SPDX-License-Identifier: Apache-2.0
// The exceptions that io throws: something outside the program is not as it must be.
#pragma once

#include <new>
#include <stdexcept>
#include <string>

namespace petzval {

/// Fault in what the user gave. what() reads "FILE: PLACE: MESSAGE", or "FILE: MESSAGE" where the
/// place is the whole file. place: a JSON path such as /accessors/3/byteOffset, or a line. message:
/// what is wrong and what to do about it, one line, no full stop.
class InputError : public std::runtime_error {
  public:
    InputError(const std::string& file, const std::string& place, const std::string& message)
        : std::runtime_error(file + ": " + (place.empty() ? "" : place + ": ") + message) {}
};

/// Calls f; where memory runs out in it, the InputError names the file that it was for.
template <class F>
decltype(auto) naming_file(const std::string& file, const F& f) {
    try {
        return f();
    } catch (const std::bad_alloc&) {
        throw InputError(file, "", "out of memory; it asks for more than there is");
    }
}

/// Request that a sound file cannot meet: a camera name that it does not have, say.
class ArgumentError : public InputError {
  public:
    using InputError::InputError;
};

}  // namespace petzval
