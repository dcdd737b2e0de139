"""The examples of the guide, run in the folder they name."""

import doctest
from pathlib import Path

from conftest import HERE

GUIDE = HERE.parents[1] / "docs" / "guide" / "python.md"


def test_the_examples_of_the_guide(monkeypatch):
    monkeypatch.chdir(HERE)
    examples = Path(GUIDE).read_text(encoding="utf-8").replace("```\n", "")
    test = doctest.DocTestParser().get_doctest(examples, {}, "python.md", str(GUIDE), 0)
    assert len(test.examples) > 25
    said = []
    doctest.DocTestRunner(optionflags=doctest.IGNORE_EXCEPTION_DETAIL).run(test, out=said.append)
    assert not said, "".join(said)
