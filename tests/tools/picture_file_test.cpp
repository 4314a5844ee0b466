#include "tools/picture_file.h"

#include <fstream>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace scree {
namespace {

template <class Function>
std::optional<ErrorKind> kindOfErrorFrom(Function function, const std::string& mustBeNamed)
{
    const test::Refusal refusal = test::refusalBy(function);
    EXPECT_TRUE(refusal.mentions(mustBeNamed)) << refusal.message;
    return refusal.kind;
}

std::size_t fileCount(const std::filesystem::path& folder)
{
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(PictureFile, ReplacesAnOlderFileAndLeavesNothingElse)
{
    const test::TemporaryFolder folder;
    writePng(folder / "a.png", Image(8, 8));
    writePng(folder / "a.png", Image(9, 7), {{"Frame", "1001"}});
    const PngContents read = readPng(folder / "a.png");
    EXPECT_EQ(read.image.width, 9);
    EXPECT_EQ(read.image.height, 7);
    EXPECT_EQ(read.text, (PngText{{"Frame", "1001"}}));
    EXPECT_EQ(fileCount(folder.path()), 1u);
}

TEST(PictureFile, NamesThePathThatCannotBeCreated)
{
    const test::TemporaryFolder folder;
    const auto path = folder / "no_such_folder/a.png";
    EXPECT_EQ(kindOfErrorFrom([&] { writePng(path, Image(8, 8)); }, path.string()),
              ErrorKind::cannotCreate);
}

TEST(PictureFile, LeavesNoTemporaryFileWhenTheNameIsTaken)
{
    const test::TemporaryFolder folder;
    const auto path = folder / "a.png";
    std::filesystem::create_directory(path);
    EXPECT_EQ(kindOfErrorFrom([&] { writePng(path, Image(8, 8)); }, path.string()),
              ErrorKind::cannotCreate);
    EXPECT_EQ(fileCount(folder.path()), 1u);
}

TEST(PictureFile, TellsAMissingFileFromADamagedOne)
{
    const test::TemporaryFolder folder;
    const auto missing = folder / "missing.png", cut = folder / "cut.png";
    EXPECT_EQ(kindOfErrorFrom([&] { readPng(missing); }, missing.string()),
              ErrorKind::missingInput);
    writePng(cut, Image(50, 50));
    std::filesystem::resize_file(cut, std::filesystem::file_size(cut) / 2);
    EXPECT_EQ(kindOfErrorFrom([&] { readPng(cut); }, cut.string()), ErrorKind::inputOutput);
    EXPECT_EQ(kindOfErrorFrom([&] { requireWholePngFile(cut); }, cut.string()),
              ErrorKind::inputOutput);
}

}  // namespace
}  // namespace scree
