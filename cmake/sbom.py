#!/usr/bin/env python3
"""What programs are made of, as SPDX 2.3: sbom.py VERSION OUT.json PROGRAM..., or the texts of their libraries' licences, one
file for each Debian package: sbom.py --licences FOLDER PROGRAM...

The shared libraries that the loader takes (ldd), and what is compiled in from headers and static libraries, each with version
and licences of the Debian package that it comes from. Elsewhere than on Debian versions and licences are NOASSERTION.
SOURCE_DATE_EPOCH sets the date.
"""
import hashlib
import json
import os
import re
import subprocess
import sys
from datetime import datetime, timezone
from pathlib import Path

# Headers, static libraries and texts that become part of the programs (docs/dependencies.md).
COMPILED_IN = ["libtinygltf-dev", "nlohmann-json3-dev", "libglm-dev", "libcli11-dev", "libnanovdb-dev", "libimgui-dev",
               "libjs-chart.js", "libstb-dev"]
# Licences' short names in Debian, and in SPDX where they differ.
SPDX = {"expat": "MIT", "mit": "MIT", "bsd-3-clause": "BSD-3-Clause", "bsd-2-clause": "BSD-2-Clause", "apache-2.0": "Apache-2.0",
        "mpl-2.0": "MPL-2.0", "zlib": "Zlib", "bsl-1.0": "BSL-1.0", "cc0-1.0": "CC0-1.0", "lgpl-2.1+": "LGPL-2.1-or-later",
        "gpl-2+": "GPL-2.0-or-later", "public-domain": "NOASSERTION"}


def output_of(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return ""


def libraries_of(program):
    """Names and files of the shared libraries, theirs included."""
    return re.findall(r"^\s*(\S+) => (/\S+)", output_of("ldd", program), re.MULTILINE)


def package_of(file):
    """The Debian package of a file: by the path that dpkg knows, with and without /usr."""
    real = os.path.realpath(file)
    for path in (file, real, real.removeprefix("/usr"), "/usr" + file):
        owner = output_of("dpkg-query", "-S", path).split(":")[0]
        if owner:
            return owner
    return None


def facts_of(package):
    """Version, and the licence of most of a package's files."""
    version = output_of("dpkg-query", "-W", "-f", "${Version}", package) or "NOASSERTION"
    try:
        copyright_text = Path("/usr/share/doc", package, "copyright").read_text(errors="replace")
    except OSError:
        return version, "NOASSERTION"
    stanza = re.search(r"^Files:\s*\*.*?^License:\s*(\S+)", copyright_text, re.MULTILINE | re.DOTALL)
    return version, SPDX.get(stanza.group(1).lower(), "NOASSERTION") if stanza else "NOASSERTION"


def entry(name, version, licence, purpose, comment, purl=None):
    out = {"SPDXID": "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name), "name": name, "versionInfo": version,
           "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": licence,
           "licenseDeclared": licence, "copyrightText": "NOASSERTION", "primaryPackagePurpose": purpose, "comment": comment}
    if purl:
        out["externalRefs"] = [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": purl}]
    return out


def debian_entry(package, comment):
    version, licence = facts_of(package)
    return entry(package, version, licence, "LIBRARY", comment, f"pkg:deb/debian/{package}@{version}")


def copy_licences(folder, packages):
    folder.mkdir(parents=True, exist_ok=True)
    for package in packages:
        text = Path("/usr/share/doc", package, "copyright")
        if text.is_file():
            (folder / package).write_bytes(text.read_bytes())


def main():
    version, out, *programs = sys.argv[1:]
    shared = {}
    for program in programs:
        for name, file in libraries_of(program):
            shared.setdefault(package_of(file) or name, set()).add(name)
    if version == "--licences":
        return copy_licences(Path(out), [*shared, *COMPILED_IN])
    packages = [entry("volgi", version, "MIT", "APPLICATION", " ".join(sorted(Path(p).name for p in programs)))]
    relationships = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-volgi"}]
    linked = [(debian_entry(p, "shared: " + " ".join(sorted(names))), "DYNAMIC_LINK") for p, names in sorted(shared.items())]
    inside = [(debian_entry(p, "compiled in"), "STATIC_LINK") for p in COMPILED_IN if output_of("dpkg-query", "-W", p)]
    for item, relation in linked + inside:
        packages.append(item)
        relationships.append({"spdxElementId": "SPDXRef-volgi", "relationshipType": relation, "relatedSpdxElement": item["SPDXID"]})
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH", datetime.now(timezone.utc).timestamp()))
    digest = hashlib.sha256(json.dumps(packages, sort_keys=True).encode()).hexdigest()
    document = {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"volgi-{version}",
                "documentNamespace": f"urn:volgi:spdx:{version}:{digest[:32]}",
                "creationInfo": {"created": datetime.fromtimestamp(epoch, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
                                 "creators": ["Tool: volgi/cmake/sbom.py"]},
                "packages": packages, "relationships": relationships}
    path = Path(out)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(document, indent=1) + "\n")


if __name__ == "__main__":
    main()
