// SPDX-License-Identifier: Apache-2.0
// petzval._core: what petzval/*.py wrap for people.
#include <dlfcn.h>
#include <pybind11/pybind11.h>

#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>

#include "apps/python/aside.h"
#include "apps/python/bindings.h"
#include "apps/python/keywords.h"
#include "apps/request/value_error.h"

namespace {

namespace py = pybind11;
using namespace petzval::apps;
namespace io = petzval::io;

// Raises one of the exceptions of petzval/_errors.py. A file's name need not be UTF-8.
void raise(const char* name, const std::string& message, const std::string& field = "") {
    const std::string spelled = as_keywords(message);
    const auto text = py::reinterpret_steal<py::object>(
        PyUnicode_DecodeFSDefaultAndSize(spelled.data(), py::ssize_t(spelled.size())));
    const py::object type = py::module_::import("petzval._errors").attr(name);
    const py::object error = type(text, field.empty() ? py::object(py::none()) : py::str(field));
    PyErr_SetObject(type.ptr(), error.ptr());
}

void translate(const std::exception_ptr& thrown) {
    try {
        std::rethrow_exception(thrown);
    } catch (const ValueError& error) {
        raise("FieldError", error.what(), as_keywords(error.option()));
    } catch (const io::OutputError& error) {
        raise("OutputError", error.what());
    } catch (const io::InputError& error) {
        raise("InputError", error.what());
    } catch (const ForkedError& error) {
        raise("Error", error.what());
    } catch (const std::bad_alloc& error) {
        const std::string what = error.what();
        raise("OutOfMemory", what == "std::bad_alloc" ? "out of memory" : what);
    } catch (const std::length_error&) {  // of a container: more than any memory
        raise("OutOfMemory", "out of memory");
    }
}

}  // namespace

// What is installed lies beside the programs of the prefix or build that this module is in.
extern "C" const char* petzval_installed_bin() {
    static const std::string folder = [] {
        namespace fs = std::filesystem;
        Dl_info self{};
        ::dladdr(reinterpret_cast<const void*>(&petzval_installed_bin), &self);
        std::error_code error;
        fs::path at = fs::canonical(self.dli_fname ? self.dli_fname : "", error);
        while (at.has_relative_path()) {
            at = at.parent_path();
            if (fs::exists(at / "share/petzval", error)) break;
        }
        return (at / "bin").string();
    }();
    return folder.c_str();
}

PYBIND11_MODULE(_core, module) {
    py::register_exception_translator([](std::exception_ptr thrown) {
        if (thrown) translate(thrown);
    });
    // Arrays of numpy 2 are known to pybind11 from 2.12 on.
    module.attr("knows_numpy_2") = PYBIND11_VERSION_HEX >= 0x020C0000;
    bind_fields(module);
    bind_image(module);
    bind_session(module);
    bind_lens(module);
}
