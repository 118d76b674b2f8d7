# SPDX-License-Identifier: Apache-2.0
"""What the nodes of a material, a lamp or a world lead to."""


def nodes_of(owner):
    return owner.node_tree.nodes if owner.use_nodes and owner.node_tree else ()


def find(socket):
    """Node that a socket gets its value from; None where nothing is linked."""
    while socket.is_linked and not socket.links[0].is_muted:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def surface_of(owner, output="OUTPUT_MATERIAL", socket="Surface"):
    """Node that the surface of a material, a lamp or a world is made by; None where it has none."""
    outputs = [node for node in nodes_of(owner) if node.type == output and node.is_active_output]
    outputs.sort(key=lambda node: node.target != "CYCLES")
    return find(outputs[0].inputs[socket]) if outputs else None


def value_of(socket):
    """A number, or a tuple, that a socket has, also from a node that is no more than a number; None where others give it."""
    source, own = find(socket), getattr(socket, "default_value", None)
    if source:
        value, wide = source.outputs[0], hasattr(own, "__len__")
        if source.type != ("RGB" if wide else "VALUE"):
            return None
        own = value.default_value
    return tuple(own) if hasattr(own, "__len__") else own
