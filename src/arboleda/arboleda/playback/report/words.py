"""The report's own words, in English and Spanish."""

from __future__ import annotations

WORDS: dict[str, tuple[str, str]] = {
    "title": ("Task {task} failed", "Falló la tarea {task}"),
    "cause": ("Cause", "Causa"),
    "cause_note": (
        "Found by rules over what the record has; the plant's own sentence was:",
        "Hallada por reglas sobre lo que hay en el registro; la frase de la propia planta fue:",
    ),
    "evidence": ("Evidence", "Pruebas"),
    "tree": ("The tree just before it failed", "El árbol justo antes de fallar"),
    "twin": (
        "Where the devices were, seen from above",
        "Dónde estaban los dispositivos, vistos desde arriba",
    ),
    "before": ("s from the failure", "s desde el fallo"),
    "messages": ("The last messages of each device", "Los últimos mensajes de cada dispositivo"),
    "messages_note": (
        "Times in s from the failure; what begins with > was sent by the plant.",
        "Tiempos en s desde el fallo; lo que empieza por > lo envió la planta.",
    ),
    "acts": ("What operators did", "Lo que hicieron los operadores"),
    "none": ("nothing", "nada"),
    "changed": ("What would have changed it", "Qué lo habría cambiado"),
    "changed_note": (
        "Forks that were really run from when the task was asked for, with virtual devices, which what "
        "befell the real ones befalls too. They say what devices as those of the simulator would have done.",
        "Bifurcaciones que se ejecutaron de verdad desde que se pidió la tarea, con dispositivos virtuales,"
        " a los que les ocurre lo mismo que a los reales."
        " Dicen lo que harían dispositivos como los del simulador.",
    ),
    "changed_nothing": (
        "Virtual devices cannot bring this failure about from the record: without any change, the task ends "
        "otherwise than it did. So forks prove nothing here, and no others were run.",
        "Con dispositivos virtuales este fallo no se reproduce a partir del registro: sin ningún cambio,"
        " la tarea termina de otro modo. Así que las bifurcaciones no prueban nada aquí, y no hay otras.",
    ),
    "without": ("without any change", "sin ningún cambio"),
    "healthy": ("had nothing befallen the devices", "si a los dispositivos no les hubiera ocurrido nada"),
    "stale": (
        "had silence been allowed for {value:g} s",
        "si se hubiera permitido un silencio de {value:g} s",
    ),
    "deadline": ("with deadline_factor {value:g}", "con deadline_factor {value:g}"),
    "again": ("Run it again", "Ejecutarlo otra vez"),
    "test": ("A test that fails in the same way", "Una prueba que falla igual"),
    "test_note": (
        "For pytest, with Arboleda's fixture sim. It is made of what the record has; run it to see.",
        "Para pytest, con el fixture sim de Arboleda. Hecha de lo que hay en el registro; ejecútela.",
    ),
    "copy": ("copy", "copiar"),
    "save": ("save as a file", "guardar como archivo"),
    "sent": ("sent", "enviado"),
    "accepted": ("accepted after {seconds:.2f} s", "aceptado tras {seconds:.2f} s"),
    "not_accepted": ("never reported as accepted", "nunca comunicado como aceptado"),
    "trouble_silence": ("silent for {seconds} s", "en silencio {seconds} s"),
    "trouble_boot": ("booted, unheard for {seconds} s", "se reinició, sin oírse {seconds} s"),
    "trouble_alarm": ("fault of its own for {seconds} s", "fallo propio durante {seconds} s"),
    "trouble_bridge": (
        "bridge started anew, unheard for {seconds} s",
        "puente reiniciado, sin oírse {seconds} s",
    ),
    "cut": ("its connection broke", "se cortó su conexión"),
    "task_end": ("end of the task", "fin de la tarea"),
    "failed_at": ("the failure", "el fallo"),
}
