"""XMI of the Bigraph Framework, held to an implementation of EMF where one is there.

`XMI_READER` names a Python with pyecore; `XMI_METAMODEL` names a metamodel that the framework wrote for its cars,
`simulation/src/test/resources/bigraphs/cars/meta-model.ecore`; `XMI_FILES` names a folder of files that it wrote.
"""

import os
import re
import subprocess
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import pytest
from bigraph_strategies import SIGNATURE, bigraphs
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from bigraphs.bigraph import Bigraph, Node, assemble
from bigraphs.canonical import equal
from bigraphs.errors import BigraphError, NotationError
from bigraphs.exchange.xmi_reading import read_xmi
from bigraphs.exchange.xmi_writing import write_xmi
from bigraphs.signature import Control, Signature

TEXT = """<?xml version="1.0" encoding="UTF-8"?>
<m:BBigraph xmlns:m="http://example.org" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <bRoots>
    <bChild xsi:type="m:Room" name="v0">
      <bChild xsi:type="m:Door" name="v1"><bPorts bLink="//@bEdges.0"/>
        <bPorts bLink="//@bOuterNames.0" index="2"/></bChild>
      <bChild xsi:type="m:BSite"/>
    </bChild>
  </bRoots>
  <bEdges name="e0"/>
  <bInnerNames name="x" bLink="//@bEdges.0"/>
  <bInnerNames name="z"/>
  <bOuterNames name="y"/>
</m:BBigraph>
"""

PEER = """
import sys
from pyecore.ecore import EClass
from pyecore.resources import URI, ResourceSet
metamodel, given, written, *controls = sys.argv[1:]
known = ResourceSet()
package = known.get_resource(URI(metamodel)).contents[0]
for name in controls:
    package.eClassifiers.append(EClass(name, superclass=(package.getEClassifier("BNode"),)))
package.nsURI = "http://org.bigraphs.model"
known.metamodel_registry[package.nsURI] = package
known.get_resource(URI(given)).save(output=URI(written))
"""


def declared_by(bigraph: Bigraph, signature: Signature) -> Bigraph:
    """Return a bigraph that was read with the controls that the writer had."""
    return assemble(
        signature,
        bigraph.nodes,
        regions=bigraph.regions,
        sites=bigraph.sites,
        edges=bigraph.edges,
        inner_links=dict(bigraph.inner_links),
        outer_names=bigraph.outer_names,
    )


@examples(200)
@given(bigraphs(max_nodes=6))
def test_a_bigraph_is_read_back_as_written(bigraph):
    assert equal(declared_by(read_xmi(write_xmi(bigraph)), SIGNATURE), bigraph)


def test_ports_have_their_index_and_those_that_are_not_linked_an_edge_of_their_own():
    found = read_xmi(TEXT)
    signature = Signature((Control("Room", 0, ordered=False), Control("Door", 3)))
    nodes = [Node("Room"), Node("Door", None, (0, 1, "y"), (0,))]
    inner = {"x": 0, "z": 2}
    expected = assemble(signature, nodes, sites=[[0]], edges=3, inner_links=inner, outer_names=["y"])
    assert found.signature == signature
    assert equal(found, expected)


@pytest.mark.parametrize(
    ("old", "new", "code", "line"),
    [
        ("<bRoots>", '<bRoots index="1">', "index", 3),
        ('index="2"', 'index="-2"', "index", 6),
        ('index="2"', 'index="0"', "index", 5),
        ('index="2"', 'index="5000"', "arity", 5),
        ("//@bOuterNames.0", "//@bOuterNames.1", "link", 6),
        ("//@bOuterNames.0", "y", "link", 6),
        ('<bEdges name="e0"/>', '<bEdges name="e0" bPoints="a b c"/>', "link", 10),
        ('name="y"', "", "name", 13),
        (' xsi:type="m:Room"', "", "control", 4),
        ("m:Room", "m:BNode", "control", 4),
        ('<bInnerNames name="z"/>', '<bInnerNames name="x"/>', "name", 12),
        ('name="y"/>', 'name="y"/><bOuterNames name="y"/>', "name", 13),
        ('name="v0"', 'name="v0" speed="3"', "attribute", 4),
        ("<bEdges", "some text<bEdges", "syntax", 10),
        ("<bEdges", "<attributes/><bEdges", "element", 10),
        ("</bRoots>", "</bRoot>", "syntax", 9),
        ("m:BBigraph", "m:BNode", "element", 2),
        ("<m:BBigraph", '<!DOCTYPE m [<!ENTITY a "b">]><m:BBigraph', "doctype", 2),
        ('<bChild xsi:type="m:BSite"/>', '<bChild xsi:type="m:BSite"><bPorts/></bChild>', "element", 7),
    ],
)
def test_what_is_no_plain_bigraph_is_refused_at_its_place(old, new, code, line):
    assert old in TEXT
    with pytest.raises(NotationError) as caught:
        read_xmi(TEXT.replace(old, new))
    assert (caught.value.code, caught.value.line) == (code, line)


def test_deep_and_long_texts_are_refused():
    deep = "<bChild xsi:type='m:Room'>" * 5000 + "</bChild>" * 5000
    for text, code in (
        (TEXT.replace("<bRoots>", "<bRoots>" + deep), "too-deep"),
        (" " * 1_000_001, "too-long"),
    ):
        with pytest.raises(NotationError) as caught:
            read_xmi(text)
        assert caught.value.code == code


@examples(100)
@given(
    st.integers(0, len(TEXT)),
    st.integers(0, 30),
    st.text(max_size=8) | st.sampled_from(re.findall(r"\S+", TEXT)),
)
def test_a_damaged_text_is_read_or_refused(start, length, put):
    with suppress(NotationError):
        found = read_xmi(TEXT[:start] + put + TEXT[start + length :])
        assert equal(declared_by(read_xmi(write_xmi(found)), found.signature), found)


A, ROOM, BNODE, CALL = Control("A", 0), Control("Room", 0), Control("BNode", 0), Control("Num(1)", 0)


@pytest.mark.parametrize(
    ("bigraph", "message"),
    [
        (assemble(Signature((A,)), [Node("A"), Node("A"), Node("A", None, (), (0, 1))]), "A is in 2 places"),
        (assemble(Signature(), [], sites=[[]]), "site 0 is in 0 places"),
        (assemble(Signature((A,)), [Node("A", "n")]), "node n:A"),
        (assemble(Signature((BNODE,)), [Node("BNode")]), "control 'BNode'"),
        (assemble(Signature((CALL,)), [Node("Num(1)")]), r"control 'Num\(1\)'"),
    ],
)
def test_what_the_format_cannot_say_is_refused_by_name(bigraph, message):
    with pytest.raises(BigraphError, match=message):
        write_xmi(bigraph)


def test_what_nests_as_deeply_as_may_be_written_is_read():
    def nested(depth):
        return assemble(Signature((ROOM,)), [Node("Room", None, (), (place - 1,)) for place in range(depth)])

    deepest = nested(198)
    assert equal(declared_by(read_xmi(write_xmi(deepest)), deepest.signature), deepest)
    with pytest.raises(BigraphError, match="deeper than 198"):
        write_xmi(nested(199))


@pytest.mark.long
@pytest.mark.skipif(
    not {"XMI_READER", "XMI_METAMODEL"} <= set(os.environ),
    reason="XMI_READER and XMI_METAMODEL name no Python with pyecore and no metamodel of the framework",
)
@examples(10)
@given(bigraphs(max_nodes=6))
def test_an_implementation_of_emf_reads_and_writes_the_same_bigraph(tmp_path_factory, bigraph):
    folder = tmp_path_factory.mktemp("xmi")
    (folder / "given.xmi").write_text(write_xmi(bigraph), encoding="utf-8")
    controls = [control.name for control in SIGNATURE.controls]
    files = [os.environ["XMI_METAMODEL"], str(folder / "given.xmi"), str(folder / "written.xmi")]
    subprocess.run([os.environ["XMI_READER"], "-c", PEER, *files, *controls], check=True, timeout=60)
    written = (folder / "written.xmi").read_text(encoding="utf-8")
    assert equal(declared_by(read_xmi(written), SIGNATURE), bigraph)


@pytest.mark.skipif(
    "XMI_FILES" not in os.environ, reason="XMI_FILES names no folder of the framework's files"
)
def test_files_of_the_framework_are_read_and_survive_being_written():
    files = sorted(Path(os.environ["XMI_FILES"]).rglob("*.xmi"))
    assert files
    for file in files:
        text = file.read_text(encoding="utf-8")
        if "<xmi:XMI" in text:  # several objects, by names: an old form
            with pytest.raises(NotationError, match="element 'XMI'"):
                read_xmi(text)
        else:
            found = read_xmi(text)
            assert found.nodes or found.sites
            again = read_xmi(write_xmi(found))
            assert equal(replace(again, signature=found.signature), found)
