#include "tools/picture/drawing.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/picture/png_reader.h"
#include "tools/picture/picture_file.h"
#include "tools/picture/raster_painter.h"
#include "tools/picture/svg_writer.h"

namespace planetree::tools {
namespace {

constexpr Rgb kRed = {255, 0, 0};

Drawing sample_drawing() {
  Drawing drawing;
  drawing.width = 40;
  drawing.height = 30;
  drawing.title = "a <b> & \"c\"";
  drawing.description = "what is here";
  drawing.metadata = R"({"key":"<value>"})";
  drawing.shapes.emplace_back(FilledBox{2, 3, 4.5, 2, kRed});
  drawing.shapes.emplace_back(Stroke{{{{10, 10.5}, {20, 10.5}}}, false, kInk, 1, 0.5});
  drawing.shapes.emplace_back(TextLine{{5, 28}, "I", 9});
  drawing.shapes.emplace_back(RasterBox{30, 20, PngImage(2, 2, {0, 0, 255})});
  return drawing;
}

TEST(RasterPainter, PaintsEveryShape) {
  const PngImage image = paint(sample_drawing());
  EXPECT_EQ(image.width(), 40u);
  EXPECT_EQ(image.at(2, 3), kRed);
  EXPECT_EQ(image.at(5, 4), kRed);
  EXPECT_EQ(image.at(1, 3), kPaper);
  EXPECT_EQ(image.at(2, 5), kPaper);
  EXPECT_EQ(image.at(6, 3), mix(kPaper, kRed, 0.5));
  EXPECT_EQ(image.at(15, 10), mix(kPaper, kInk, 0.5));
  EXPECT_EQ(image.at(15, 9), kPaper);
  EXPECT_EQ(image.at(5, 23), kInk);
  EXPECT_EQ(image.at(30, 20).blue, 255);
  EXPECT_EQ(image.at(31, 21).red, 0);
}

// Lines of one stroke are not darker where they cross.
TEST(RasterPainter, CoversAPlaceOnceForAStroke) {
  Drawing drawing;
  drawing.width = drawing.height = 9;
  drawing.shapes.emplace_back(
      Stroke{{{{0, 4.5}, {9, 4.5}}, {{4.5, 0}, {4.5, 9}}}, false, kInk, 1, 0.5});
  const PngImage image = paint(drawing);
  EXPECT_EQ(image.at(4, 4), image.at(2, 4));
  EXPECT_EQ(image.at(4, 4), image.at(4, 7));
  EXPECT_NE(image.at(4, 4), kPaper);
}

TEST(RasterPainter, LeavesOutWhatIsBeyondThePicture) {
  Drawing drawing;
  drawing.width = drawing.height = 4;
  drawing.shapes.emplace_back(FilledBox{-10, -10, 12, 12, kRed});
  drawing.shapes.emplace_back(Stroke{{{{-1e9, 3.5}, {1e9, 3.5}}}});
  drawing.shapes.emplace_back(RasterBox{3, 3, PngImage(2, 2, kRed)});
  drawing.shapes.emplace_back(TextLine{{-50, 2}, "text"});
  const PngImage image = paint(drawing);
  EXPECT_EQ(image.at(1, 1), kRed);
  EXPECT_EQ(image.at(2, 2), kPaper);
  EXPECT_EQ(image.at(0, 3), kInk);
  EXPECT_EQ(image.at(3, 3), kRed);
}

TEST(SvgWriter, HasTextsAsTextAndRastersAsPng) {
  const auto text = svg_text(sample_drawing());
  ASSERT_TRUE(text);
  for (const char* part :
       {"<title id='title'>a &lt;b&gt; &amp; &quot;c&quot;</title>",
        "<desc id='desc'>what is here</desc>",
        "<metadata>{&quot;key&quot;:&quot;&lt;value&gt;&quot;}</metadata>",
        "<rect x='2' y='3' width='4.5' height='2' fill='#ff0000'/>", "stroke-opacity='0.5'",
        "d='M10 10.5L20 10.5'", ">I</text>", "<image x='30' y='20' width='2' height='2'",
        "data:image/png;base64,iVBORw0KGgo"})
    EXPECT_NE(text->find(part), std::string::npos) << part << '\n' << *text;
}

TEST(PictureFile, IsChosenByItsExtension) {
  for (const char* name : {"a.png", "b.PNG", "c.svg", "-"}) EXPECT_EQ(picture_complaint(name), "");
  for (const char* name : {"a", "a.jpg", "png", ".png/x"})
    EXPECT_NE(picture_complaint(name).find("neither a .png nor a .svg"), std::string::npos) << name;
  const storage::TemporaryDirectory folder;
  ASSERT_TRUE(write_picture(sample_drawing(), folder / "a.png", false));
  ASSERT_TRUE(write_picture(sample_drawing(), folder / "a.SVG", false));
  const ReadPng read = read_png(folder / "a.png");
  EXPECT_EQ(read.width, 40u);
  EXPECT_EQ(read.at(2, 3), kRed);
  EXPECT_EQ(read.texts.at(kMetadataKey), sample_drawing().metadata);
  EXPECT_EQ(storage::read_bytes(folder / "a.SVG")[1], std::byte{'s'});
}

TEST(PictureFile, FailsWithoutLeavingAFile) {
  const storage::TemporaryDirectory folder;
  const Drawing drawing = sample_drawing();
  const auto code = [&](const std::filesystem::path& path) {
    const auto written = write_picture(drawing, path, false);
    EXPECT_FALSE(written);
    return written ? ErrorCode::kBadInput : written.error().code;
  };
  EXPECT_EQ(code(folder / "absent/image.png"), ErrorCode::kNotFound);
  EXPECT_EQ(code("/dev/full"), ErrorCode::kNoSpace);
  ASSERT_TRUE(write_picture(drawing, folder / "image.png", false));
  EXPECT_EQ(code(folder / "image.png"), ErrorCode::kAlreadyExists);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "."),
                          std::filesystem::directory_iterator()),
            1);
}

}  // namespace
}  // namespace planetree::tools
