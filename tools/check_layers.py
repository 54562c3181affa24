#!/usr/bin/env python3
"""Checks that includes follow the order of the folders in tools/layers.txt, and that files in cycles are declared there.

A file here is a .c file with its header: a/b.c and a/b.h are a/b. Two files are in a cycle if each includes the header of the other,
directly or through others.
"""

import os
import re
import sys

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def read_rules(path):
    allowed, cycles = {}, {}
    for line in open(path):
        line = line.split("#")[0].strip()
        if not line:
            continue
        head, tail = line.split(":", 1)
        if head.startswith("cycle "):
            cycles[frozenset(head.split()[1:])] = tail.strip()
        else:
            allowed[head] = tail.split()
    return allowed, cycles


def read_includes(folders):
    """The files that each file includes."""
    includes = {}
    for top in sorted({folder.split("/")[0] for folder in folders}):
        for folder, _, names in os.walk(top):
            for name in names:
                if name.endswith((".c", ".h")):
                    path = os.path.join(folder, name)
                    found = re.findall(r'^#include "([^"]+)"', open(path).read(), re.M)
                    includes.setdefault(path[:-2], set()).update(f[:-2] for f in found if os.path.exists(f) and f.endswith(".h"))
    for path in includes:
        includes[path].discard(path)
    return includes


def find_cycles(graph):
    """Sets of two or more nodes, of which each leads to all others (Tarjan 1972, without recursion)."""
    number, low, stack, on_stack, found = {}, {}, [], set(), []
    for root in graph:
        if root in number:
            continue
        work = [(root, iter(graph.get(root, ())))]
        number[root] = low[root] = len(number)
        stack.append(root)
        on_stack.add(root)
        while work:
            node, rest = work[-1]
            for following in rest:
                if following not in number:
                    number[following] = low[following] = len(number)
                    stack.append(following)
                    on_stack.add(following)
                    work.append((following, iter(graph.get(following, ()))))
                    break
                if following in on_stack:
                    low[node] = min(low[node], number[following])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == number[node]:
                    component = set()
                    while node not in component:
                        component.add(stack.pop())
                    on_stack -= component
                    if len(component) > 1:
                        found.append(frozenset(component))
    return found


def main():
    os.chdir(HERE)
    allowed, declared = read_rules("tools/layers.txt")
    includes = read_includes(allowed)
    bad = []
    for path, targets in sorted(includes.items()):
        folder = os.path.dirname(path)
        if folder not in allowed:
            bad.append(f"{path}: the folder {folder} is not in tools/layers.txt")
            continue
        for target in sorted(targets):
            to = os.path.dirname(target)
            if to != folder and not any(to == a or to.startswith(a + "/") for a in allowed[folder]):
                bad.append(f"{path}: includes {target}.h, but {folder} may not use {to}")
    cycles = find_cycles(includes)
    for cycle in cycles:
        if cycle not in declared:
            bad.append("not declared: cycle " + " ".join(sorted(cycle)))
    for cycle in declared:
        if cycle not in cycles:
            bad.append("not a cycle any more: " + " ".join(sorted(cycle)))
    for line in bad:
        print("check-layers:", line)
    if not bad:
        print(f"check-layers: ok ({sum(map(len, cycles))} files in {len(cycles)} declared cycles)")
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main())
