"""Arrays of a campaign database, read without fatmc."""
import sqlite3

import numpy as np


def arrays(path, cell):
    """name -> runs x values, of the trials of a cell that are ok, in the order of repetitions."""
    db = sqlite3.connect(path)
    out = {}
    rows = db.execute("SELECT a.name, a.data FROM arrays a JOIN trials t ON t.cell = a.cell AND t.repetition = a.repetition "
                      "WHERE a.cell = ? AND t.outcome = 'ok' ORDER BY a.repetition", (cell,))
    for name, data in rows:
        out.setdefault(name, []).append(np.frombuffer(data, "<f8"))
    return {name: np.array(values) for name, values in out.items()}
