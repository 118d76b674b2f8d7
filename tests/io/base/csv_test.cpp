// SPDX-License-Identifier: Apache-2.0
#include "io/file/csv.h"

#include <gtest/gtest.h>

#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

using test::TemporaryFolder;

std::filesystem::path file_of(const TemporaryFolder& folder, const std::string& text) {
    const auto path = folder / "table.csv";
    test::write_text(path, text);
    return path;
}

CsvTable read(const std::string& text) {
    const TemporaryFolder folder;
    return read_csv(file_of(folder, text));
}

TEST(Csv, ReadsNumbersUnderNames) {
    const CsvTable table = read("wavelength_nm,value\n400,0.25\n410,-1.5e-3\n");
    EXPECT_EQ(table.names, (std::vector<std::string>{"wavelength_nm", "value"}));
    EXPECT_EQ(table.rows, (std::vector<std::vector<double>>{{400, 0.25}, {410, -1.5e-3}}));
    EXPECT_EQ(table.place(1), "line 3");
}

TEST(Csv, AllowsWhatSpreadsheetsAndEditorsWrite) {
    const std::vector<std::vector<double>> rows{{400, 0.5}, {410, 2}};
    EXPECT_EQ(read("\xEF\xBB\xBFnm,v\r\n400,0.5\r\n410,2\r\n").rows, rows) << "BOM and CRLF";
    EXPECT_EQ(read("nm,v\n400,0.5\n410,2").rows, rows) << "no line end at the end";
    EXPECT_EQ(read(" nm ,\tv\n 400 , .5 \n\t+410,+2\t\n").rows, rows) << "spaces, tabs, signs";
    EXPECT_EQ(read("# a\n\nnm,v\n# b, c\n400,0.5\n  \n  # d\n410,2\n").rows, rows) << "comments";
    EXPECT_EQ(read("nm,v\n4E2,5e-1\n410,2.0\n").rows, rows) << "exponents";
    EXPECT_EQ(read("# a\n\nnm,v\n400,0.5\n").line_of_row, std::vector<int>{4});
    EXPECT_EQ(read("\xEF\xBB\xBFnm,v\n400,0.5\n").names[0], "nm");
}

TEST(Csv, ErrorsNameFileAndLine) {
    struct Case {
        std::string text, place, message;
    };
    const Case cases[] = {
        {"nm,v\n400,0.5\n410\n", "line 3", "number of columns is 1, and 2"},
        {"nm,v\n400,0.5,1\n", "line 2", "number of columns is 3, and 2"},
        {"nm,v\n400,0.5,\n", "line 2", "number of columns is 3, and 2"},
        {"nm,v\n400;0,5;1,2\n", "line 2", "separate columns by commas"},
        {"nm,v\n400,\n", "line 2", "column 2 is not a finite number"},
        {"nm,v\n,0.5\n", "line 2", "column 1 is not a finite number"},
        {"# x\n\nnm,v\n400,0.5x\n", "line 4", "column 2 is not"},
        {"nm,v\n400,0x10\n", "line 2", "column 2 is not"},
        {"nm,v\n400,1 2\n", "line 2", "column 2 is not"},
        {"nm,v\n400,+-1\n", "line 2", "column 2 is not"},
        {"nm,v\n400,\"1\"\n", "line 2", "column 2 is not"},
        {"nm,v\n400,nan\n", "line 2", "column 2 is not"},
        {"nm,v\n400,-inf\n", "line 2", "column 2 is not"},
        {"nm,v\n400,1e999\n", "line 2", "column 2 is not"},
        {"nm,v\n400," + std::string(9000, '7') + "x\n", "line 2", "column 2 is not"},
        {std::string("nm,v\n400,\0\n", 11), "line 2", "is not text"},
        {"nm,v\n400,\x1b[31m\n", "line 2", "is not text"},
        {"nm,v\r400,0.5\r", "line 1", "is not text"},
        {std::string("\xFF\xFEn\0m\0", 6), "line 1", "is not text"},
        {"", "", "is empty"},
        {"nm,v\n", "line 1", "without a row"},
        {"# only\n# comments\n", "line 2", "without a row"},
        {"400,0.5\n410,2\n", "", "has no line of names"},
    };
    const TemporaryFolder folder;
    for (const auto& [text, place, message] : cases) {
        const auto path = file_of(folder, text);
        const std::string said = refusal([&] { (void)read_csv(path); });
        const std::string head = path.string() + ": " + (place.empty() ? "" : place + ": ");
        EXPECT_TRUE(said.starts_with(head)) << said;
        EXPECT_TRUE(has(said, message));
        EXPECT_LT(said.size(), path.string().size() + 200) << said;
    }
}

TEST(Csv, RefusesFilesThatAreNone) {
    const TemporaryFolder folder;
    const auto said = [](const std::filesystem::path& path) {
        return refusal([&] { (void)read_csv(path); });
    };
    EXPECT_TRUE(has(said(folder / "none.csv"), "none.csv: no such file"));
    EXPECT_TRUE(has(said(folder.path()), "is a folder"));
    EXPECT_TRUE(has(said("/dev/zero"), "is not a regular file"));
}

// A sparse file: 64 GiB would not fit in memory.
TEST(Csv, RefusesHugeFilesBeforeItReadsThem) {
    const TemporaryFolder folder;
    const auto path = file_of(folder, "nm,v\n400,0.5\n");
    std::filesystem::resize_file(path, uintmax_t(64) << 30);
    EXPECT_TRUE(has(refusal([&] { (void)read_csv(path); }), "has 68719476736 bytes"));
}

TEST(Csv, TextCellsAreTrimmed) {
    const TemporaryFolder folder;
    const CsvText table = read_csv_text(file_of(folder, "maker,name\n a b ,  c\n,\n"));
    EXPECT_EQ(table.rows, (std::vector<std::vector<std::string>>{{"a b", "c"}, {"", ""}}));
}

}  // namespace
}  // namespace petzval::io
