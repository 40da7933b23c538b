"""run_pages.py [--quick] HYDRODIP SOURCE [PAGE...]: runs what the documentation says.

Of the guides (docs/guide/) and the other pages of docs/, every block of ```sh is run, page by page in a
fresh folder, in the order of the page; examples/jobs is there. A comment before a block says more about it:
    <!-- not run: why -->   is not run
    <!-- file: NAME -->     the block, of whatever kind, is written to NAME
--quick: only the short guides are run, on a coarse film without pictures; ./dev docs commands runs all.

Of all pages, guides or not, every command that begins with `hydrodip` is held against the program:
the command exists, and each of its options."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

QUICK_PAGES = ("index", "files")
QUICK = {"print": "--quality draft --dpi 60", "pattern": "--quality draft --dpi 60", "plan": "--quality draft",
         "orient": "--quality draft", "nest": "--quality draft --dpi 60", "simulate": "--quality draft"}


def blocks(text):
    """(line, comment, kind, lines) of every fenced block."""
    comment, block = "", None
    for number, line in enumerate(text.splitlines(), 1):
        if block is None and (fence := re.fullmatch(r"```(\w*).*", line)):
            block = (number, comment, fence[1], [])
        elif block is not None and line.startswith("```"):
            yield block
            block, comment = None, ""
        elif block is not None:
            block[3].append(line)
        elif said := re.fullmatch(r"<!-- (.*) -->", line.strip()):
            comment = said[1]
        elif line.strip():
            comment = ""


def run_page(page, hydrodip, source, quick):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        shutil.copytree(source / "examples", work / "examples")
        (work / "bin").mkdir()
        program = work / "bin" / "hydrodip"
        cases = "".join(f'  {command}) shift; exec "{hydrodip}" {command} "$@" {options} ;;\n'
                        for command, options in QUICK.items() if quick)
        program.write_text(f'#!/bin/sh\ncase ${{1:-}} in\n{cases}  *) exec "{hydrodip}" "$@" ;;\nesac\n')
        program.chmod(0o755)
        path = f"{work / 'bin'}:{os.environ['PATH']}"
        ran = 0
        for line, comment, kind, lines in blocks(page.read_text()):
            if comment.startswith("file: "):
                (work / comment[6:]).write_text("\n".join(lines) + "\n")
            elif kind == "sh" and not comment.startswith("not run"):
                script = "set -e\n" + "\n".join(lines) + "\n"
                done = subprocess.run(["sh", "-c", script], cwd=work, env={**os.environ, "PATH": path, "HOME": folder, "XDG_CONFIG_HOME": folder},
                                      stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                ran += sum(1 for each in lines if each.strip() and not each.startswith("#"))
                if done.returncode != 0:
                    print(f"FAILED: {page}:{line}: exit code {done.returncode}\n{done.stdout[-2000:]}")
                    return ran, False
        return ran, True


def described(hydrodip):
    """The options of every command."""
    def said(*words):
        return subprocess.run([hydrodip, *words, "--help"], capture_output=True, text=True).stdout
    listed = re.search(r"Commands:\n(.*?)\n\n", said(), re.S)[1]
    names = [line[2:].split("  ")[0].strip() for line in listed.splitlines()]
    return {name: set(re.findall(r"(?<![\w-])(--[a-z][a-z-]*|-o)\b", said(*name.split()))) | {"--help"} for name in names}


def commands_in(text):
    """(line, words) of what is written as code and begins with hydrodip."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            for part in re.split(r"&&|\||;", line.split(" #")[0]):
                words = part.split()
                if words and re.fullmatch(r"(build/release/)?hydrodip", words[0]):
                    yield number, words[1:]
        else:
            for code in re.findall(r"`(hydrodip [^`]*)`", line):
                yield number, code.split()[1:]


def check_names(page, known):
    """Commands and options that the program does not have."""
    wrong = []
    groups = {name.split()[0] for name in known}
    for number, words in commands_in(page.read_text()):
        if not words or words[0] in ("--help", "--version") or not re.fullmatch(r"[a-z]+", words[0]):
            continue
        name = " ".join(words[:2]) if " ".join(words[:2]) in known else words[0]
        if name not in known:
            if words[0] not in groups:
                wrong.append(f"{page}:{number}: there is no command '{name}'")
            continue
        for word in words:
            option = word.split("=")[0].strip("[],")
            if option.startswith("--") and option not in known[name]:
                wrong.append(f"{page}:{number}: hydrodip {name} has no {option}")
    return wrong


def main():
    arguments = sys.argv[1:]
    quick = "--quick" in arguments
    hydrodip, source, *pages = [a for a in arguments if a != "--quick"]
    hydrodip, source = os.path.abspath(hydrodip), pathlib.Path(source)
    guides = [pathlib.Path(p) for p in pages] or sorted((source / "docs").glob("**/*.md"))
    known = described(hydrodip)
    wrong = []
    for page in guides + ([] if pages else [source / "README.md"]):
        wrong += check_names(page, known)
    for sentence in wrong:
        print("FAILED:", sentence)
    good = not wrong
    for page in guides:
        if quick and page.stem not in QUICK_PAGES or "```sh" not in page.read_text():
            continue
        ran, passed = run_page(page, hydrodip, source, quick)
        print(f"{page.name}: {ran} lines run" if passed else f"{page.name}: failed")
        good = good and passed
    sys.exit(0 if good else 1)


main()
