#!/usr/bin/env python3
"""links.py SOURCE_DIR: every page and heading that a comment or a page cites is in the repository.

Looked at: pages, and headings behind them, that comments name from the root, and relative links in Markdown. A bare page
name, such as that of a note which only its writer has, is an error.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
FOLDERS = ('apps', 'cmake', 'core', 'data', 'docs', 'propagation', 'reference', 'screen', 'shaders', 'tests', 'voxel')
SUFFIXES = ('.h', '.cpp', '.inl', '.glsl', '.txt', '.cmake', '.py', '.sh', '.md', '.js')
CITED = re.compile(r'(?<![\w./-])((?:docs/)?(?:[\w.-]+/)*[\w.-]+\.md)(#[\w-]+)?')
LINKED = re.compile(r'\]\(([^)\s:#]*)(#[\w-]+)?\)')
COMMENT = {'.h': '//', '.cpp': '//', '.inl': '//', '.glsl': '//', '.js': '//'}  # of the others: #


def headings(page):
    """Anchors as GitHub makes them."""
    names = re.findall(r'^#+ +(.*)$', page.read_text(encoding='utf-8'), re.M)
    return {'#' + re.sub(r'[^\w -]', '', name.lower()).replace(' ', '-') for name in names}


def sources():
    yield root / 'README.md'
    yield root / 'CMakeLists.txt'
    for folder in FOLDERS:
        yield from (p for p in sorted((root / folder).rglob('*')) if p.suffix in SUFFIXES and p.is_file())


def main():
    wrong, checked = [], 0
    for source in sources():
        for number, line in enumerate(source.read_text(encoding='utf-8').split('\n'), 1):
            if source.suffix == '.md':
                found = [(m.groups(), source.parent / m[1] if m[1] else source) for m in LINKED.finditer(line)]
            else:
                comment = line.partition(COMMENT.get(source.suffix, '#'))[2]
                found = [(m.groups(), root / m[1]) for m in CITED.finditer(comment)]
            for (page, heading), target in found:
                checked += 1
                if not target.exists():
                    wrong.append(f'{source.relative_to(root)}:{number}: there is no {page}')
                elif heading and heading not in headings(target):
                    wrong.append(f'{source.relative_to(root)}:{number}: {target.name} has no {heading}')
    print(*wrong, sep='\n')
    print(f'{checked} links and citations, {len(wrong)} of them lead nowhere')
    sys.exit(1 if wrong or checked < 50 else 0)


main()
