// The names of other files in an OBJ that is written to another folder.
#include "scratch_files.h"

using namespace alcove;

namespace {

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class ObjFiles : public ScratchFiles {
  protected:
    ObjFiles() {
        std::filesystem::create_directories(path("in/skin"));
        std::filesystem::create_directories(path("out/deep"));
        for (const char* name : {"in/cube.mtl", "in/skin/cube.mtl", "in/my skin.mtl", "in/other.mtl"})
            write(name, "newmtl a\n");
    }

    /// Reads an OBJ of `line` and a triangle, writes it to `file`, and keeps the messages. \return the text before the
    /// triangle.
    std::string written(const std::string& line, const std::string& file = "out/a.obj") {
        told_ = write_mesh(read("in/a.obj", line + triangle), path(file));
        const std::string text = bytes_of(file);
        EXPECT_TRUE(text.ends_with(triangle));
        return text.substr(0, text.size() - triangle.size());
    }
    void expect_told(const std::string& words) const {
        ASSERT_EQ(told_.size(), 1u);
        EXPECT_NE(told_[0].find(words), std::string::npos) << told_[0];
    }

    std::vector<std::string> told_;
};

}

TEST_F(ObjFiles, NamesLeadToTheSameFilesFromTheFolderOfTheOutput) {
    EXPECT_EQ(written("mtllib skin/cube.mtl\n"), "mtllib ../in/skin/cube.mtl\n");
    expect_told("1 path was rewritten relative to the output folder: 'skin/cube.mtl' is now '../in/skin/cube.mtl'");
    EXPECT_EQ(written("mtllib cube.mtl # the skin\r\n", "out/deep/a.obj"), "mtllib ../../in/cube.mtl # the skin\r\n");
    EXPECT_EQ(written("mtllib ./skin/cube.mtl\n", "a.obj"), "mtllib in/skin/cube.mtl\n");
    EXPECT_EQ(written("mtllib ../in/cube.mtl\n", "in/skin/a.obj"), "mtllib ../cube.mtl\n");
    EXPECT_EQ(written("maplib cube.mtl\nshadow_obj a.obj\ntrace_obj a.obj\n"),
              "maplib ../in/cube.mtl\nshadow_obj ../in/a.obj\ntrace_obj ../in/a.obj\n");
    expect_told("3 paths were rewritten");
}

TEST_F(ObjFiles, NamesMayHaveBlanksQuotesAndBackslashes) {
    EXPECT_EQ(written("mtllib my skin.mtl\n"), "mtllib ../in/my skin.mtl\n");
    EXPECT_EQ(written("mtllib cube.mtl my skin.mtl  other.mtl\n"),
              "mtllib ../in/cube.mtl ../in/my skin.mtl  ../in/other.mtl\n");
    expect_told("3 paths were rewritten");
    EXPECT_EQ(written("mtllib \"my skin.mtl\"\n"), "mtllib \"../in/my skin.mtl\"\n");
    EXPECT_EQ(written("mtllib skin\\cube.mtl\n"), "mtllib ../in/skin/cube.mtl\n");
    EXPECT_EQ(written("mtllib cube.mtl \\\n other.mtl\n"), "mtllib ../in/cube.mtl \\\n ../in/other.mtl\n");
}

TEST_F(ObjFiles, NamesThatNeedNoChangeAreKept) {
    const std::string absolute = "mtllib " + path("in/cube.mtl").string() + "\n";
    for (const std::string& line : {absolute, std::string("mtllib C:\\skins\\cube.mtl\n"), std::string("mtllib\n"),
                                    std::string("# mtllib cube.mtl\n"), std::string("usemtl cube.mtl\n")}) {
        EXPECT_EQ(written(line), line);
        EXPECT_TRUE(told_.empty());
    }
    for (const char* file : {"in/b.obj", "in/skin/../b.obj", "out/../in/b.obj"}) {
        EXPECT_EQ(written("mtllib skin/cube.mtl none.mtl\n", file), "mtllib skin/cube.mtl none.mtl\n");
        EXPECT_TRUE(told_.empty());
    }
    std::filesystem::create_directory_symlink(path("in/skin"), path("out/skin"));
    EXPECT_EQ(written("mtllib skin/cube.mtl\n"), "mtllib skin/cube.mtl\n");
    EXPECT_TRUE(told_.empty());
}

TEST_F(ObjFiles, NamesOfMissingFilesAreKeptAndTold) {
    EXPECT_EQ(written("mtllib none.mtl\n"), "mtllib none.mtl\n");
    expect_told("1 path was kept, but no such file was found relative to the input folder: 'none.mtl' in line 1");
    EXPECT_EQ(written("g a\nmtllib cube.mtl none.mtl\n"), "g a\nmtllib ../in/cube.mtl none.mtl\n");
    ASSERT_EQ(told_.size(), 2u);
    EXPECT_NE(told_[1].find("'none.mtl' in line 2"), std::string::npos) << told_[1];
}

TEST_F(ObjFiles, ColoursAndNamesChangeTogether) {
    Mesh mesh = read("in/a.obj", "v 0 0 0\nmtllib cube.mtl\nv 1 0 0\nv 0 1 0\nf 1 2 3\nmtllib other.mtl");
    mesh.added_colors.assign(3, Color{255, 255, 255, 255});
    write_mesh(mesh, path("out/a.obj"));
    EXPECT_EQ(bytes_of("out/a.obj"),
              "v 0 0 0 1.0000 1.0000 1.0000\nmtllib ../in/cube.mtl\nv 1 0 0 1.0000 1.0000 1.0000\n"
              "v 0 1 0 1.0000 1.0000 1.0000\nf 1 2 3\nmtllib ../in/other.mtl");
}

TEST_F(ObjFiles, TheNumberOfLookUpsIsLimited) {
    std::string lines;
    for (int i = 0; i < 5000; ++i)
        lines += "mtllib a b c d e f g h i j k l m n o p q r s t\n";
    EXPECT_EQ(written(lines), lines);
    expect_told("100,000 paths were kept");
}
