"""validate.py SCHEMAS PATH...: every report.json, plan.json, orient.json, nest.json, plan.toml and
profile.toml in the folders given, and the job files given, against its schema. *.KIND.printed.json is
what a command printed with --json. Says how many of each there were.

To readers the schemas of what the program writes leave further keys open, as new ones may come. Here
a key that no schema has is a mistake.

validate.py --refuses SCHEMAS FILE...: each of these has to be refused; a schema that takes anything
would pass as well."""

import collections
import json
import pathlib
import sys
import tomllib

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)

KINDS = {"report.json": "report", "plan.json": "plan", "orient.json": "orient", "nest.json": "nest",
         "correction.json": "correction",
         "plan.toml": "job", "profile.toml": "job", "truth.toml": "job"}

# Where what is unknown is refused: an editor shows a mistyped name.
TYPED_BY_PEOPLE = {"job.schema.json"}


def closed(schema):
    """The same schema with nothing allowed that it does not name."""
    if isinstance(schema, list):
        return [closed(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    result = {key: closed(value) for key, value in schema.items()}
    if isinstance(schema.get("properties"), dict) and "type" in schema:
        result.setdefault("additionalProperties", False)
    return result


def is_open(schema):
    """Whether who reads with this schema, as it is installed, may meet a later version's files."""
    if isinstance(schema, list):
        return all(map(is_open, schema))
    if not isinstance(schema, dict):
        return True
    return schema.get("additionalProperties") is not False and all(map(is_open, schema.values()))


def validators(folder):
    schemas = {p.name: json.loads(p.read_text()) for p in folder.glob("*.schema.json")}
    for name, schema in schemas.items():
        jsonschema.Draft202012Validator.check_schema(schema)
        if schema["$id"] != name:
            sys.exit(f"{name}: its $id is {schema['$id']}")
        if name not in TYPED_BY_PEOPLE and not is_open(schema):
            sys.exit(f"{name}: takes no keys but today's; docs/guide/files.md says that new ones may come")
    schemas = {name: closed(schema) for name, schema in schemas.items()}
    made = {}
    for name, schema in schemas.items():
        resolver = jsonschema.RefResolver("", schema, store=schemas)
        made[name.removesuffix(".schema.json")] = jsonschema.Draft202012Validator(schema, resolver=resolver)
    return made


def read(path):
    if path.suffix == ".toml":
        return tomllib.loads(path.read_text())
    return json.loads(path.read_text())


def kind_of(path, given):
    if path.name.endswith(".printed.json"):
        return path.name.split(".")[-3]
    return KINDS.get(path.name, "job" if path == given else None)


def kind_of_report(content):
    """None of a stand-in, which is of a job that a test needs."""
    if not isinstance(content, dict) or not {"schema_version", "command"} <= content.keys():
        return None
    return "inspect" if content["command"] == "inspect" else "report"


def refuse(by_kind, files):
    for path in files:
        content, kind = read(path), kind_of(path, path)
        if kind == "report":
            kind = kind_of_report(content)
        if not any(by_kind[kind].iter_errors(content)):
            sys.exit(f"FAILED: taken: {path.read_text()[:300]}")


def main():
    arguments = sys.argv[1:]
    if arguments[0] == "--refuses":
        return refuse(validators(pathlib.Path(arguments[1])), list(map(pathlib.Path, arguments[2:])))
    by_kind = validators(pathlib.Path(arguments[0]))
    counts = collections.Counter()
    wrong = 0
    for given in map(pathlib.Path, arguments[1:]):
        for path in sorted(given.rglob("*")) if given.is_dir() else [given]:
            kind = kind_of(path, given)
            if kind is None or not path.is_file():
                continue
            try:
                content = read(path)
            except ValueError:  # tests damage files, too
                continue
            if kind == "report":
                kind = kind_of_report(content)
            if kind is None:
                counts["stand-in (a test's own)"] += 1
                continue
            counts[kind] += 1
            for error in by_kind[kind].iter_errors(content):
                wrong += 1
                where = "/".join(str(part) for part in error.absolute_path)
                print(f"FAILED: {path}: {where}: {error.message[:300]}")
    print(", ".join(f"{count} {kind}" for kind, count in sorted(counts.items())) or "no files")
    if wrong:
        sys.exit(1)
    if not counts:
        sys.exit("no file was found")


main()
